#include "core/chain/sines.hpp"

#include <cmath>

namespace hagfish {

// A loop for each, since GCC makes one call of one angle of both. CMakeLists.txt has the flag that
// lets it call for several.
void sines_and_cosines(const Eigen::Ref<const Eigen::VectorXd>& angles, Eigen::VectorXd& sine,
                       Eigen::VectorXd& cosine) {
  const Eigen::Index count = angles.size();
  sine.resize(count);
  cosine.resize(count);
  const double* const from = angles.data();
  double* const s = sine.data();
  double* const c = cosine.data();
  for (Eigen::Index i = 0; i < count; ++i) s[i] = std::sin(from[i]);
  for (Eigen::Index i = 0; i < count; ++i) c[i] = std::cos(from[i]);
}

}  // namespace hagfish
