#include "experiments/film/fit/film_shape.hpp"

#include <algorithm>

#include "core/chain/state.hpp"
#include "core/muscle/active_curvature.hpp"

namespace hagfish {
namespace {

int body_at(const Model& model, double place) {
  return std::clamp(static_cast<int>(place * model.body_count()), 0, model.body_count() - 1);
}

}  // namespace

Eigen::Vector3d point_on(const Model& model, const Kinematics& kin, double place) {
  const int body = body_at(model, place);
  const double past = place * model.body_count() - body;
  return kin.origin.col(body) + past * model.bodies[body].length * kin.rotation[body].col(0);
}

ProgramShape::ProgramShape(const Model& model, const std::vector<double>& stations, bool flat)
    : model_(model),
      stations_(static_cast<Eigen::Index>(stations.size())),
      axes_(flat ? 1 : 2),
      shares_(model.nv(), values()),
      parts_(model.nv()) {
  for (Eigen::Index j = 0; j < values(); ++j) {
    CurvatureProgram unit{{0}, stations, {Eigen::Matrix3Xd::Zero(3, stations_)}, {}};
    unit.value[0](flat ? 1 : j / stations_, j % stations_) = 1;
    shares_.col(j) = program_shape(model, unit, 0);
    for (Eigen::Index dof = root_dofs; dof < model.nv(); ++dof) {
      if (shares_(dof, j) != 0) parts_[dof].push_back({j, shares_(dof, j)});
    }
  }
}

void ProgramShape::place_bodies(const Eigen::VectorXd& values, Kinematics& kin) const {
  Eigen::VectorXd q = rest_state(model_).q;
  q.tail(q.size() - root_dofs - 1) = shares_.bottomRows(model_.nv() - root_dofs) * values;
  update_positions(model_, q, kin);
}

Eigen::Matrix3Xd ProgramShape::points(const Eigen::VectorXd& values,
                                      const std::vector<double>& place) const {
  Kinematics kin;
  place_bodies(values, kin);
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(place.size()));
  for (Eigen::Index k = 0; k < points.cols(); ++k) points.col(k) = point_on(model_, kin, place[k]);
  return points;
}

Eigen::Matrix3Xd ProgramShape::points(const Eigen::VectorXd& values,
                                      const std::vector<double>& place,
                                      Eigen::MatrixXd& rate) const {
  Kinematics kin;
  place_bodies(values, kin);
  const auto n = static_cast<Eigen::Index>(place.size());
  Eigen::Matrix3Xd points(3, n);
  rate.resize(3 * n, this->values());
  // The twist of the body that the walk has come to, by each value.
  Matrix6Xd twist = Matrix6Xd::Zero(6, this->values());
  int next_dof = root_dofs;
  for (Eigen::Index k = 0; k < n; ++k) {
    points.col(k) = point_on(model_, kin, place[k]);
    const Body& body = model_.bodies[body_at(model_, place[k])];
    for (; next_dof < body.first_dof + body.dofs; ++next_dof) {
      for (const Part& part : parts_[next_dof]) {
        twist.col(part.value) += part.share * kin.axis.col(next_dof);
      }
    }
    const Eigen::Vector3d from = points.col(k) - kin.reference;
    for (Eigen::Index j = 0; j < rate.cols(); ++j) {
      rate.block<3, 1>(3 * k, j) = point_velocity(twist.col(j), from);
    }
  }
  return points;
}

}  // namespace hagfish
