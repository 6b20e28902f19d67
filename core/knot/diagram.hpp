// Diagrams of knots: which edges of a polygon pass over which others, seen from one side.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <random>
#include <vector>

namespace hagfish {

/// One of the two visits of the polygon to a crossing.
struct Passage {
  int edge = 0;   ///< the edge from vertex `edge` to the next one
  double at = 0;  ///< distance from the edge's start, projected length
  int crossing = 0;
  bool over = false;
};

/// Signed Gauss code of a closed polygon. Passages are in the order of the polygon; each crossing
/// left has two.
struct Diagram {
  std::vector<Passage> passages;
  /// Sign by crossing, whether left or not: +1 where the over strand turns anticlockwise into the
  /// under strand.
  std::vector<int> sign;
  /// Whether the projection tells each passage from the next and over from under; where it does
  /// not, the rest says nothing.
  bool generic = true;
};

/// The diagram of the closed polygon through the columns of `points` (3 x n, n >= 3, any length
/// unit) seen along `direction` (of any length). It is not generic where a length is below 1e-7 of
/// the polygon's size, and so never where the polygon touches itself or repeats a vertex.
Diagram diagram_of_closed(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& direction);

/// Rectangles in a projection.
struct Rectangles {
  Eigen::ArrayXd left, right, bottom, top;
};

/// Bounding rectangles of projected edges, and of batches of edges that follow each other: most
/// batches are clear of an edge.
struct EdgeBoxes {
  Rectangles edges, batches;
};

/// An open polygon seen along one direction, for closures of it by different ways: what it crosses
/// of itself is found once, which is nearly all of the work.
class SeenArc {
 public:
  /// The polygon through the columns of `points` (3 x n, n >= 2), whose ends go on for `far` (same
  /// unit) to where they are joined.
  SeenArc(const Eigen::Matrix3Xd& points, double far, const Eigen::Vector3d& direction);

  /// The diagram of the polygon closed by two edges from its ends along `out` (unit) and one that
  /// joins these; generic as of diagram_of_closed, and never where the arc itself is not.
  Diagram closed(const Eigen::Vector3d& out);

 private:
  double far_;
  Eigen::Matrix3d axes_;   // the third one points at the observer
  Eigen::Matrix3Xd view_;  // along them; the last two columns are the ends of the closure
  double tolerance_;       // same unit
  EdgeBoxes boxes_;        // boxes of the edges of view_
  Diagram own_;            // diagram of the arc, passages in its order
};

/// Diagrams of an open polygon whose ends are joined far away, by directions drawn at random.
/// The type of a closure does not depend on where it is seen from. So all are seen from one side,
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
