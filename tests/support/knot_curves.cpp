#include "tests/support/knot_curves.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/support/random_chain.hpp"

namespace hagfish {
namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

Eigen::Matrix3Xd torus_knot(int q) {
  return sample(90, 0, 2 * pi, [q](double t) {
    const double r = 2 + std::cos(q * t);
    return Eigen::Vector3d(r * std::cos(2 * t), r * std::sin(2 * t), std::sin(q * t));
  });
}

Eigen::Matrix3Xd figure_eight() {
  return sample(90, 0, 2 * pi, [](double t) {
    const double r = 2 + std::cos(2 * t);
    return Eigen::Vector3d(r * std::cos(3 * t), r * std::sin(3 * t), std::sin(4 * t));
  });
}

Eigen::Matrix3Xd lissajous_5_2() {
  return sample(90, 0, 2 * pi, [](double t) {
    return Eigen::Vector3d(std::cos(2 * t + 0.2), std::cos(3 * t + 0.7), std::cos(7 * t));
  });
}

Eigen::Matrix3Xd braid_closure(const std::vector<int>& word, int strands) {
  std::vector<Eigen::Vector3d> points;
  const double length = static_cast<double>(word.size());
  int y = 0;
  int rounds = 0;
  do {
    for (std::size_t k = 0; k < word.size(); ++k) {
      const int lower = std::abs(word[k]) - 1;
      const double x = static_cast<double>(k);
      if (y == lower || y == lower + 1) {
        const bool over = (y == lower) == (word[k] > 0);
        y = 2 * lower + 1 - y;
        points.emplace_back(x + 0.5, lower + 0.5, over ? 0.3 : -0.3);
      }
      points.emplace_back(x + 1, y, 0);
    }
    // Back under the braid on nested rectangles, which do not cross.
    points.emplace_back(length + 1 + y, y, 0);
    points.emplace_back(length + 1 + y, -1 - y, 0);
    points.emplace_back(-1 - y, -1 - y, 0);
    points.emplace_back(-1 - y, y, 0);
    ++rounds;
  } while (y != 0);
  if (rounds != strands) throw std::logic_error("the closure of this braid is not one knot");
  Eigen::Matrix3Xd polygon(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) polygon.col(static_cast<int>(i)) = points[i];
  return polygon;
}

Eigen::Matrix3Xd mirrored(Eigen::Matrix3Xd points) {
  points.row(2) *= -1;
  return points;
}

Eigen::Matrix3Xd started_at(const Eigen::Matrix3Xd& points, Eigen::Index first) {
  const Eigen::Index rest = points.cols() - first;
  Eigen::Matrix3Xd turned(3, points.cols());
  turned << points.rightCols(rest), points.leftCols(first);
  return turned;
}

Eigen::Matrix3Xd opened(const Eigen::Matrix3Xd& closed) {
  const Eigen::Vector3d mean = closed.rowwise().mean();
  Eigen::Index outermost = 0;
  const double radius = (closed.colwise() - mean).colwise().norm().maxCoeff(&outermost);
  const Eigen::Matrix3Xd turned = started_at(closed, outermost);
  const Eigen::Vector3d outward = (turned.col(0) - mean).normalized();
  const Eigen::Vector3d pull = 30 * radius * outward.unitOrthogonal();
  const Eigen::Vector3d other_end = turned.col(0) + 0.01 * radius * outward;
  Eigen::Matrix3Xd open(3, turned.cols() + 3);
  open << turned.col(0) - pull, turned, other_end, other_end + pull;
  return open;
}

Eigen::Matrix3Xd random_polygon(int count, std::mt19937& random) {
  Eigen::Matrix3Xd points(3, count);
  for (auto column : points.colwise()) column = random_vector(random);
  return points;
}

}  // namespace hagfish
