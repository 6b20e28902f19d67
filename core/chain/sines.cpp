#include "core/chain/sines.hpp"

namespace hagfish {

// A loop for each, since GCC makes one call of one angle of both. CMakeLists.txt has the flag that
// lets it call for several. Near whole turns that library's cosine is even to rounding alone: so it
// is taken of the angle's size, which is stored first, as GCC would leave out the size of a
// cosine's argument.
void sines_and_cosines(const Eigen::Ref<const Eigen::VectorXd>& angles, Eigen::VectorXd& sine,
                       Eigen::VectorXd& cosine) {
#if defined(HAGFISH_LIBRARY_SINES)
  sine = angles;
  cosine = angles.cwiseAbs();
  double* const s = sine.data();
  double* const c = cosine.data();
  const Eigen::Index count = angles.size();
  for (Eigen::Index i = 0; i < count; ++i) s[i] = std::sin(s[i]);
  for (Eigen::Index i = 0; i < count; ++i) c[i] = std::cos(c[i]);
#else
  sine.resize(angles.size());
  cosine.resize(angles.size());
  for (Eigen::Index i = 0; i < angles.size(); ++i) {
    const SineCosine of = plain_sine_and_cosine(angles[i]);
    sine[i] = of.sine;
    cosine[i] = of.cosine;
  }
#endif
}

}  // namespace hagfish
