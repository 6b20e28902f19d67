#include "core/knot/writhe.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hagfish {
namespace {

/// Share of all directions, times 2 pi and signed, from which the edges p q and r s are seen to
/// cross: the area of a spherical quadrangle.
double crossing_area(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r,
                     const Eigen::Vector3d& s) {
  const Eigen::Vector3d corner[4] = {
      (r - p).cross(s - p).normalized(), (s - p).cross(s - q).normalized(),
      (s - q).cross(r - q).normalized(), (r - q).cross(r - p).normalized()};
  double area = 0;
  for (int k = 0; k < 4; ++k) {
    area += std::asin(std::clamp(corner[k].dot(corner[(k + 1) % 4]), -1.0, 1.0));
  }
  const double sense = (s - r).cross(q - p).dot(r - p);
  return sense == 0 ? 0 : std::copysign(area, sense);
}

}  // namespace

double writhe(const Eigen::Matrix3Xd& points) {
  double sum = 0;
  for (Eigen::Index i = 0; i + 1 < points.cols(); ++i) {
    for (Eigen::Index j = i + 2; j + 1 < points.cols(); ++j) {
      sum += crossing_area(points.col(i), points.col(i + 1), points.col(j), points.col(j + 1));
    }
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace hagfish
