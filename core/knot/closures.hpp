// Diagrams of an open polygon whose ends are joined far away, by directions drawn at random.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <random>

#include "core/knot/diagram.hpp"

namespace hagfish {

/// What type a closure is does not depend on where it is seen from. So all are seen from one side,
/// until turn() is called.
class RandomClosures {
 public:
  /// Closures of the polygon through the columns of `centreline` (3 x n, n >= 2, any length unit),
  /// which must outlive this. The same `seed` gives the same directions on every platform.
  RandomClosures(const Eigen::Matrix3Xd& centreline, unsigned seed);

  /// The diagram of the next closure; not generic where the closure or the line of sight is not.
  Diagram draw();

  /// The next closure is seen from elsewhere.
  void turn() { seen_.reset(); }

 private:
  const Eigen::Matrix3Xd& centreline_;
  std::mt19937 random_;
  double far_;
  std::optional<SeenArc> seen_;
};

}  // namespace hagfish
