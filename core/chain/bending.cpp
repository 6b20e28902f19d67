#include "core/chain/bending.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

/// The X axis of the tailward body in the frame of the headward one: cos θ along X, and across it
/// sin θ in the direction of the bend.
struct Direction {
  double along = 1;  ///< cos y cos z
  double z = 0;      ///< -Z component, sin y cos z
  double y = 0;      ///< Y component, sin z
  double across = 0;
};

Direction direction(double y, double z) {
  Direction d;
  d.along = std::cos(y) * std::cos(z);
  d.z = std::sin(y) * std::cos(z);
  d.y = std::sin(z);
  d.across = std::hypot(d.y, d.z);
  return d;
}

}  // namespace

Bend total_bend(double y, double z) {
  const Direction d = direction(y, z);
  // The arc tangent keeps all digits of small angles, which the arc cosine loses.
  Bend bend{std::atan2(d.across, d.along)};
  if (d.across > 0) bend.slope << d.z / d.across, std::cos(y) * d.y / d.across;
  return bend;
}

Eigen::Vector2d bend_to(double y, double z, double angle) {
  const double scale = std::min(1.0, angle / std::max(std::abs(y), std::abs(z)));
  const Direction d = direction(scale * y, scale * z);
  const double across = std::sin(angle) / d.across;
  return {std::atan2(across * d.z, std::cos(angle)),
          std::asin(std::clamp(across * d.y, -1.0, 1.0))};
}

double past_cone(const BendingCone& cone, const Eigen::VectorXd& q) {
  const auto angles = q.segment<2>(cone.dof + 1);
  // θ <= sqrt(y² + z²): most joints are within their cones by this.
  if (angles.squaredNorm() <= cone.limit * cone.limit) return 0;
  const double angle = std::max(total_bend(angles[0], angles[1]).angle,
                                angles.lpNorm<Eigen::Infinity>());  // the first up to 90 degrees
  return std::max(0.0, angle - cone.limit);
}

}  // namespace hagfish
