// The spline of a body that lies along the open trefoil of the tests.
#pragma once

#include <vector>

#include "tests/support/random_chain.hpp"

namespace hagfish {

/// Its crossings are some 0.7 `height` (cm) apart.
inline std::vector<SplineSegment> trefoil(const Model& fish, double height) {
  const int n = fish.body_count();
  Eigen::Matrix3Xd centre(3, n);
  for (int b = 0; b < n; ++b) centre.col(b) = trefoil_point((b + 0.5) / n, height);
  return spline(fish, centre);
}

}  // namespace hagfish
