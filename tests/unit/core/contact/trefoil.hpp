// Splines of bodies that touch themselves: along the open trefoil of the tests, and in two legs.
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

/// Of 100 bodies: the first half along X at y = `shift`, the other half along Y at x = `shift`, `z`
/// above it. The legs are straight and cross at right angles. cm.
inline std::vector<SplineSegment> crossing_legs(const Model& fish, double shift, double z) {
  Eigen::Matrix3Xd centre(3, 100);
  for (int b = 0; b < 50; ++b) {
    centre.col(b) << 0.424 * (b - 25), shift, 0;
    centre.col(b + 50) << shift, 0.424 * (b - 25), z;
  }
  return spline(fish, centre);
}

}  // namespace hagfish
