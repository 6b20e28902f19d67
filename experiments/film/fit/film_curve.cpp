#include "experiments/film/fit/film_curve.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

/// Weight of squared third differences of neighbouring nodes against the squared distance of a
/// film's points, as many as nodes: smooths what is shorter than a tenth of the body.
constexpr double third_differences = 3;
/// Of second differences: where no point tells, the curve becomes straight in the end.
constexpr double second_differences = 1e-4;

/// Adds weight (sum of c_k x_{at + k})^2 to a quadratic form.
template <std::size_t N>
void add_square(const std::array<double, N>& c, Eigen::Index at, double weight,
                Eigen::MatrixXd& form) {
  for (std::size_t a = 0; a < N; ++a) {
    for (std::size_t b = 0; b < N; ++b) {
      form(at + static_cast<Eigen::Index>(a), at + static_cast<Eigen::Index>(b)) +=
          weight * c[a] * c[b];
    }
  }
}

}  // namespace

Eigen::Matrix3d turn_to(const Eigen::Vector3d& along) {
  if (along.z() == 0) {
    return Eigen::AngleAxisd(std::atan2(along.y(), along.x()), Eigen::Vector3d::UnitZ())
        .toRotationMatrix();
  }
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), along).toRotationMatrix();
}

Eigen::Matrix3Xd curve_through(const FilmFrame& frame) {
  constexpr Eigen::Index n = curve_nodes;
  Eigen::MatrixXd form = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, 3);
  const double weight = static_cast<double>(n) / static_cast<double>(frame.place.size());
  for (std::size_t k = 0; k < frame.place.size(); ++k) {
    const double at = frame.place[k] * (n - 1);
    const Eigen::Index i = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(at), 0, n - 2);
    const double share = at - static_cast<double>(i);
    add_square(std::array{1 - share, share}, i, weight, form);
    const Eigen::RowVector3d point = frame.point.col(static_cast<Eigen::Index>(k)).transpose();
    right.row(i) += weight * (1 - share) * point;
    right.row(i + 1) += weight * share * point;
  }
  for (Eigen::Index i = 0; i + 2 < n; ++i) {
    add_square(std::array{1.0, -2.0, 1.0}, i, second_differences, form);
  }
  for (Eigen::Index i = 0; i + 3 < n; ++i) {
    add_square(std::array{1.0, -3.0, 3.0, -1.0}, i, third_differences, form);
  }
  return form.ldlt().solve(right).transpose();
}

CurveBends bends_along(const Eigen::Matrix3Xd& curve, Eigen::Index stations) {
  const Eigen::Index edges = curve.cols() - 1;
  Eigen::Matrix3Xd tangent = curve.rightCols(edges) - curve.leftCols(edges);
  for (Eigen::Index i = 0; i < edges; ++i) {
    const double way = tangent.col(i).norm();
    Eigen::Vector3d before = Eigen::Vector3d::UnitX();
    if (i > 0) before = tangent.col(i - 1);
    tangent.col(i) = way > 0 ? Eigen::Vector3d(tangent.col(i) / way) : before;
  }
  CurveBends bends{turn_to(tangent.col(0)), Eigen::MatrixXd::Zero(stations, 2)};
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(stations);
  Eigen::Matrix3d turn = bends.head;
  for (Eigen::Index i = 1; i < edges; ++i) {
    // The turn from one edge to the next, in the axes of the first, which it carries on.
    const Eigen::Vector3d next = turn.transpose() * tangent.col(i);
    const Eigen::Quaterniond by =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), next);
    const Eigen::AngleAxisd angle(by);
    const Eigen::Vector3d bend = angle.angle() * angle.axis() * static_cast<double>(edges);
    turn = turn * by.toRotationMatrix();
    const double at = static_cast<double>(i * (stations - 1)) / static_cast<double>(edges);
    for (Eigen::Index j = std::max<Eigen::Index>(0, static_cast<Eigen::Index>(at) - 1);
         j <= std::min<Eigen::Index>(stations - 1, static_cast<Eigen::Index>(at) + 2); ++j) {
      const double share = std::max(0.0, 1 - std::abs(static_cast<double>(j) - at) / 1.5);
      bends.bends.row(j) += share * bend.tail<2>().transpose();
      weight[j] += share;
    }
  }
  for (Eigen::Index j = 0; j < stations; ++j) bends.bends.row(j) /= std::max(weight[j], 1e-9);
  return bends;
}

RigidMotion nearest_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Eigen::Matrix4d motion = Eigen::umeyama(from, to, false);
  return {motion.topLeftCorner<3, 3>(), motion.topRightCorner<3, 1>()};
}

}  // namespace hagfish
