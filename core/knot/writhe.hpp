// Writhe of the open centreline: tells a knot from its mirror image, which the invariants of
// knot.hpp do not.
#pragma once

#include <Eigen/Core>

namespace hagfish {

/// The signed crossings of the open polygon through the columns of `points` (3 x n, any length
/// unit), averaged over all directions of view: the Gauss integral, summed over pairs of edges
/// (Klenin and Langowski 2000, method 1a). Positive for right-handed knots; 0 for a plane curve.
/// A mirror image has exactly the opposite writhe.
double writhe(const Eigen::Matrix3Xd& points);

}  // namespace hagfish
