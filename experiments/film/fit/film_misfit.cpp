#include "experiments/film/fit/film_misfit.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace hagfish {
namespace {

double weight_of(double r, double far) { return r <= far ? 1 : far * far / (r * r); }

Eigen::Matrix3Xd in_head(const Eigen::Matrix3Xd& points, const FilmPose& pose, double scale) {
  return scale * (pose.rotation.transpose() * (points.colwise() - pose.shift));
}

}  // namespace

FilmPose moved(const FilmPose& pose, const Eigen::VectorXd& step, double scale) {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero(), shift = turn;
  if (step.size() == 3) {
    turn.z() = step[0];
    shift.head<2>() = step.tail<2>();
  } else {
    turn << (step.size() > 5 ? step[5] : 0), step[0], step[1];
    shift = step.segment<3>(2);
  }
  FilmPose out;
  const double angle = turn.norm();
  out.rotation = pose.rotation;
  if (angle > 0) {
    out.rotation = pose.rotation * Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  }
  out.shift = pose.shift + pose.rotation * shift / scale;
  return out;
}

double cost_of(double r, double far) {
  return r <= far ? r * r : far * far * (1 + 2 * std::log(r / far));
}

Eigen::MatrixXd distances(const ProgramShape& shape, const FilmFrame& frame,
                          const Eigen::VectorXd& values, const FilmPose& pose, double scale) {
  return (shape.points(values, frame.place) - in_head(frame.point, pose, scale))
      .topRows(dimensions(shape));
}

Misfit misfit(const ProgramShape& shape, const FilmFrame& frame, const Eigen::VectorXd& values,
              const FilmPose& pose, double scale, Eigen::Index pose_size) {
  const Eigen::Index dims = dimensions(shape);
  Eigen::MatrixXd rate;
  const Eigen::Matrix3Xd own = shape.points(values, frame.place, rate);
  const Eigen::Matrix3Xd film = in_head(frame.point, pose, scale);
  const Eigen::Index n = own.cols();
  Misfit misfit;
  misfit.dimensions = dims;
  misfit.off.resize(dims * n);
  misfit.rate.resize(dims * n, rate.cols());
  misfit.by_pose = Eigen::MatrixXd::Zero(dims * n, pose_size);
  misfit.by_scale.resize(dims * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto rows = Eigen::seqN(dims * k, dims);
    misfit.off(rows) = (own.col(k) - film.col(k)).head(dims);
    misfit.rate(rows, Eigen::all) = rate.middleRows(3 * k, dims);
    misfit.by_scale(rows) = -film.col(k).head(dims);
    const Eigen::Vector3d p = own.col(k);
    Eigen::MatrixXd by(3, pose_size);
    if (pose_size == 3) {
      by << -p.y(), 1, 0, p.x(), 0, 1, 0, 0, 0;
    } else {
      by.leftCols<5>() << p.z(), -p.y(), 1, 0, 0,  //
          0, p.x(), 0, 1, 0,                       //
          -p.x(), 0, 0, 0, 1;
      if (pose_size > 5) by.col(5) << 0, -p.z(), p.y();
    }
    misfit.by_pose(rows, Eigen::all) = by.topRows(dims);
  }
  return misfit;
}

double weigh(Misfit& misfit, double far) {
  const Eigen::Index dims = misfit.dimensions;
  double cost = 0;
  for (Eigen::Index k = 0; k < misfit.off.size() / dims; ++k) {
    const auto rows = Eigen::seqN(dims * k, dims);
    const double r = misfit.off(rows).norm(), root = std::sqrt(weight_of(r, far));
    cost += cost_of(r, far);
    if (root == 1) continue;
    misfit.off(rows) *= root;
    misfit.rate(rows, Eigen::all) *= root;
    misfit.by_pose(rows, Eigen::all) *= root;
    misfit.by_scale(rows) *= root;
  }
  return cost;
}

}  // namespace hagfish
