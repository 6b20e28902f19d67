// Closed and open polygons of known knot type. Points are columns; lengths have no unit.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

namespace hagfish {

/// `count` points of a curve over [from, to), as columns.
template <class Curve>
Eigen::Matrix3Xd sample(int count, double from, double to, const Curve& curve) {
  Eigen::Matrix3Xd points(3, count);
  for (int i = 0; i < count; ++i) points.col(i) = curve(from + (to - from) * i / count);
  return points;
}

/// T(2, q): q windings through the hole of a torus, two around its axis.
Eigen::Matrix3Xd torus_knot(int q);
Eigen::Matrix3Xd figure_eight();
/// Lissajous knot 5_2 of frequencies 2, 3, 7.
Eigen::Matrix3Xd lissajous_5_2();
/// Closure of a braid: generator +-i swaps strands i and i + 1, the sign says which one is over.
/// Throws std::logic_error where the closure is not one knot.
Eigen::Matrix3Xd braid_closure(const std::vector<int>& word, int strands);

/// z to -z.
Eigen::Matrix3Xd mirrored(Eigen::Matrix3Xd points);
/// Closed polygon with `first` as its first vertex.
Eigen::Matrix3Xd started_at(const Eigen::Matrix3Xd& points, Eigen::Index first);
/// The closed polygon cut where it is farthest from its mean, both ends pulled 30 radii away from
/// each other in the tangent plane of the ball that holds the knot.
Eigen::Matrix3Xd opened(const Eigen::Matrix3Xd& closed);

/// Vertices even over the cube of side 2.
Eigen::Matrix3Xd random_polygon(int count, std::mt19937& random);

}  // namespace hagfish
