#include "core/knot/diagram.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace hagfish {
namespace {

/// Lengths below this share of the polygon's radius count as degenerate. Edges whose ends are all
/// farther than that from each other's line cross at a sine of at least as much, and then the place
/// of the crossing is rounded by less than a fifth of it: no decision made depends on rounding.
constexpr double least_share = 1e-7;

/// A crossing of two edges of the projection.
struct Meeting {
  double at_first, at_second;  ///< from the edge's start, projected length
  bool first_over;
  int sign;  ///< as Diagram::sign
};

constexpr int batch = 8;  // edges tested together: few cross

double cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Columns: axes of the view, the third one pointing at the observer.
Eigen::Matrix3d axes_along(const Eigen::Vector3d& direction) {
  Eigen::Matrix3d axes;
  axes.col(2) = direction.normalized();
  axes.col(0) = axes.col(2).unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

/// Where edge a-b crosses edge c-d in projection, if it does. Where `tolerance` cannot tell,
/// `generic` becomes false.
std::optional<Meeting> meet(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c, const Eigen::Vector3d& d, double tolerance,
                            bool& generic) {
  const Eigen::Vector3d first = b - a;
  const Eigen::Vector3d second = d - c;
  const double first_length = first.head<2>().norm();
  const double second_length = second.head<2>().norm();
  // Distances from the line through the other edge. A side is decided beyond the tolerance only.
  const double to_c = cross(first, c - a) / first_length;
  const double to_d = cross(first, d - a) / first_length;
  if (std::min(to_c, to_d) > tolerance || std::max(to_c, to_d) < -tolerance) return std::nullopt;
  const double to_a = cross(second, a - c) / second_length;
  const double to_b = cross(second, b - c) / second_length;
  if (std::min(to_a, to_b) > tolerance || std::max(to_a, to_b) < -tolerance) return std::nullopt;

  const double nearest = std::min({std::abs(to_a), std::abs(to_b), std::abs(to_c), std::abs(to_d)});
  const double turn = cross(first, second);
  // The sign of this volume tells over from under without the place of the crossing.
  const double volume = first.cross(second).dot(c - a);
  // Written so that the nan of an edge seen end on is degenerate too.
  const bool decided =
      nearest > tolerance && std::abs(volume) > tolerance * first.norm() * second.norm();
  if (!decided) {
    generic = false;
    return std::nullopt;
  }

  return Meeting{.at_first = first_length * to_a / (to_a - to_b),
                 .at_second = second_length * to_c / (to_c - to_d),
                 .first_over = (volume > 0) != (turn > 0),
                 .sign = volume > 0 ? -1 : 1};
}

/// Vertex of the closed polygon `view`: behind the last comes the first.
auto vertex(const Eigen::Matrix3Xd& view, int k) { return view.col(k < view.cols() ? k : 0); }

void set_box(const Eigen::Matrix3Xd& view, int edge, Rectangles& edges) {
  const auto from = vertex(view, edge);
  const auto to = vertex(view, edge + 1);
  edges.left[edge] = std::min(from.x(), to.x());
  edges.right[edge] = std::max(from.x(), to.x());
  edges.bottom[edge] = std::min(from.y(), to.y());
  edges.top[edge] = std::max(from.y(), to.y());
}

/// `count` rectangles, all empty, and a batch more. They overlap none.
Rectangles empty_rectangles(Eigen::Index count) {
  const Eigen::Index size = count + batch;
  Rectangles none;
  none.left = none.bottom = Eigen::ArrayXd::Constant(size, INFINITY);
  none.right = none.top = Eigen::ArrayXd::Constant(size, -INFINITY);
  return none;
}

/// Boxes of the edges of the closed polygon `view`.
EdgeBoxes boxes_of_edges(const Eigen::Matrix3Xd& view) {
  const int count = static_cast<int>(view.cols());
  const int batches = (count + batch - 1) / batch;
  EdgeBoxes boxes{empty_rectangles(count), empty_rectangles(batches)};
  for (int edge = 0; edge < count; ++edge) set_box(view, edge, boxes.edges);
  for (int k = 0; k < batches; ++k) {
    boxes.batches.left[k] = boxes.edges.left.segment<batch>(batch * k).minCoeff();
    boxes.batches.right[k] = boxes.edges.right.segment<batch>(batch * k).maxCoeff();
    boxes.batches.bottom[k] = boxes.edges.bottom.segment<batch>(batch * k).minCoeff();
    boxes.batches.top[k] = boxes.edges.top.segment<batch>(batch * k).maxCoeff();
  }
  return boxes;
}

/// By how much rectangle `i` of `a` is clear of those from `first` on of `b`; negative: overlaps.
Eigen::Array<double, batch, 1> clearance(const Rectangles& a, int i, const Rectangles& b,
                                         int first) {
  return (b.left.segment<batch>(first) - a.right[i])
      .max(a.left[i] - b.right.segment<batch>(first))
      .max(b.bottom.segment<batch>(first) - a.top[i])
      .max(a.bottom[i] - b.top.segment<batch>(first));
}

/// Visits those of [begin, end) in `b` that rectangle `i` of `a` is not clear of by more than
/// `tolerance`.
template <class Visit>
void visit_near(const Rectangles& a, int i, const Rectangles& b, int begin, int end,
                double tolerance, const Visit& visit) {
  for (int first = begin / batch * batch; first < end; first += batch) {
    const auto apart = clearance(a, i, b, first);
    if (!(apart <= tolerance).any()) continue;
    for (int j = std::max(first, begin); j < std::min(first + batch, end); ++j) {
      if (apart[j - first] <= tolerance) visit(j);
    }
  }
}

/// Adds the crossings of an edge of `view` with those of [begin, end).
void cross_edges(const Eigen::Matrix3Xd& view, const EdgeBoxes& boxes, int edge, int begin, int end,
                 double tolerance, Diagram& diagram) {
  const int last_batch = (end + batch - 1) / batch;
  visit_near(boxes.edges, edge, boxes.batches, begin / batch, last_batch, tolerance, [&](int k) {
    const int from = std::max(begin, batch * k);
    const int to = std::min(end, batch * (k + 1));
    visit_near(boxes.edges, edge, boxes.edges, from, to, tolerance, [&](int j) {
      const auto meeting = meet(vertex(view, edge), vertex(view, edge + 1), vertex(view, j),
                                vertex(view, j + 1), tolerance, diagram.generic);
      if (!meeting) return;
      const int crossing = static_cast<int>(diagram.sign.size());
      diagram.sign.push_back(meeting->sign);
      diagram.passages.push_back({edge, meeting->at_first, crossing, meeting->first_over});
      diagram.passages.push_back({j, meeting->at_second, crossing, !meeting->first_over});
    });
  });
}

bool earlier(const Passage& p, const Passage& q) {
  return std::pair(p.edge, p.at) < std::pair(q.edge, q.at);
}

/// Notes where the order of passages that follow each other is not beyond `tolerance`.
void check_order(double tolerance, Diagram& diagram) {
  const std::vector<Passage>& passages = diagram.passages;
  for (std::size_t k = 1; k < passages.size(); ++k) {
    if (passages[k].edge == passages[k - 1].edge &&
        passages[k].at - passages[k - 1].at <= tolerance) {
      diagram.generic = false;
    }
  }
}

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

Diagram diagram_of_closed(const Eigen::Matrix3Xd& points, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d middle = points.rowwise().mean();
  const Eigen::Matrix3Xd view = axes_along(direction).transpose() * (points.colwise() - middle);
  const int count = static_cast<int>(view.cols());
  const double tolerance = least_share * view.colwise().norm().maxCoeff();
  const EdgeBoxes boxes = boxes_of_edges(view);
  Diagram diagram;
  for (int i = 0; i + 2 < count; ++i) {
    // The last edge ends where the first one starts.
    cross_edges(view, boxes, i, i + 2, i == 0 ? count - 1 : count, tolerance, diagram);
  }
  std::ranges::sort(diagram.passages, earlier);
  check_order(tolerance, diagram);
  return diagram;
}

SeenArc::SeenArc(const Eigen::Matrix3Xd& points, double far, const Eigen::Vector3d& direction)
    : far_(far), axes_(axes_along(direction)), view_(3, points.cols() + 2) {
  const int count = static_cast<int>(points.cols());
  const Eigen::Vector3d middle = points.rowwise().mean();
  view_.leftCols(count) = axes_.transpose() * (points.colwise() - middle);
  view_.rightCols<2>().setZero();
  tolerance_ = least_share * (far + view_.colwise().norm().maxCoeff());
  boxes_ = boxes_of_edges(view_);
  for (int i = 0; i + 2 < count - 1; ++i) {
    cross_edges(view_, boxes_, i, i + 2, count - 1, tolerance_, own_);
  }
  std::ranges::sort(own_.passages, earlier);
}

Diagram SeenArc::closed(const Eigen::Vector3d& out) {
  const int count = static_cast<int>(view_.cols()) - 2;
  const Eigen::Vector3d way = far_ * (axes_.transpose() * out);
  view_.col(count) = view_.col(count - 1) + way;
  view_.col(count + 1) = view_.col(0) + way;
  Diagram diagram = own_;
  for (int edge = count - 1; edge <= count + 1; ++edge) set_box(view_, edge, boxes_.edges);
  // The edges at the ends of the arc share a vertex with it.
  cross_edges(view_, boxes_, count - 1, 0, count - 2, tolerance_, diagram);
  cross_edges(view_, boxes_, count, 0, count - 1, tolerance_, diagram);
  cross_edges(view_, boxes_, count + 1, 1, count, tolerance_, diagram);
  const auto added = diagram.passages.begin() + static_cast<std::ptrdiff_t>(own_.passages.size());
  std::sort(added, diagram.passages.end(), earlier);
  std::inplace_merge(diagram.passages.begin(), added, diagram.passages.end(), earlier);
  check_order(tolerance_, diagram);
  return diagram;
}

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
