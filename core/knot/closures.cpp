#include "core/knot/closures.hpp"

#include <cmath>

namespace hagfish {
namespace {

/// Uniform on the sphere, from the generator's bits alone: the same on every platform.
Eigen::Vector3d random_direction(std::mt19937& random) {
  while (true) {
    Eigen::Vector3d point;
    for (double& coordinate : point) coordinate = static_cast<double>(random()) * 0x1p-31 - 1;
    const double square = point.squaredNorm();
    if (square > 0.01 && square < 1) return point / std::sqrt(square);
  }
}

}  // namespace

RandomClosures::RandomClosures(const Eigen::Matrix3Xd& centreline, unsigned seed)
    : centreline_(centreline), random_(seed) {
  // The edge that joins the ends must pass outside the ball around the centreline; more than two
  // radii away is enough, and farther would only cost precision.
  const Eigen::Vector3d middle = centreline.rowwise().mean();
  far_ = 4 * (centreline.colwise() - middle).colwise().norm().maxCoeff();
}

Diagram RandomClosures::draw() {
  const Eigen::Vector3d out = random_direction(random_);
  const Eigen::Vector3d sight = random_direction(random_);
  if (!seen_) seen_.emplace(centreline_, far_, sight);
  return seen_->closed(out);
}

}  // namespace hagfish
