#include "experiments/mechanics/held_rod.hpp"

#include <Eigen/Dense>
#include <utility>

#include "core/chain/dynamics.hpp"

namespace hagfish {

HeldRod::HeldRod(RodChain chain, RodEnds ends)
    : model_(std::move(chain.model)),
      ends_(std::move(ends)),
      angles_(chain.state.q.tail(model_.nv() - root_dofs)) {
  const Kinematics kin = at(angles_);
  place_ = tail_end(kin);
  rotation_ = kin.rotation.back();
  multipliers_ = jacobian(kin).transpose().colPivHouseholderQr().solve(-acting(angles_));
}

Kinematics HeldRod::at(const Eigen::VectorXd& angles) const {
  State state = rest_state(model_);
  state.q.tail(angles.size()) = angles;
  return kinematics(model_, state);
}

Eigen::Vector3d HeldRod::tail_end(const Kinematics& kin) const {
  return kin.origin.rightCols<1>() + model_.bodies.back().length * kin.rotation.back().col(0);
}

Eigen::Vector3d HeldRod::turned(const Kinematics& kin) const {
  const Eigen::AngleAxisd turn(kin.rotation.back() * rotation_.transpose());
  return turn.angle() * turn.axis();
}

Eigen::VectorXd HeldRod::constraint(const Kinematics& kin) const {
  Vector6d tail;
  tail << tail_end(kin) - place_, turned(kin);
  Eigen::VectorXd all(multipliers_.size());
  all << tail(ends_.tail), kin.origin.row(2)(ends_.level).transpose();
  return all;
}

/// Moments at the hinges of a force and a moment on the tail end.
Eigen::VectorXd HeldRod::at_hinges(const Kinematics& kin, const Eigen::Vector3d& force,
                                   const Eigen::Vector3d& moment) const {
  Matrix6Xd wrench = Matrix6Xd::Zero(6, model_.body_count());
  wrench.rightCols<1>() << moment + (tail_end(kin) - kin.reference).cross(force), force;
  return generalised_force(model_, kin, wrench).tail(angles_.size());
}

/// The same of a unit force along z on a body that is held level.
Eigen::VectorXd HeldRod::level_row(const Kinematics& kin, int body) const {
  Matrix6Xd wrench = Matrix6Xd::Zero(6, model_.body_count());
  const Eigen::Vector3d place = kin.origin.col(body);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  wrench.col(body) << (place - kin.reference).cross(up), up;
  return generalised_force(model_, kin, wrench).tail(angles_.size());
}

Eigen::MatrixXd HeldRod::jacobian(const Kinematics& kin) const {
  Eigen::MatrixXd rows(ends_.tail.size() + ends_.level.size(), angles_.size());
  Eigen::Index i = 0;
  for (const int way : ends_.tail) {
    const Vector6d unit = Vector6d::Unit(way);
    rows.row(i++) = at_hinges(kin, unit.head<3>(), unit.tail<3>());
  }
  for (const int body : ends_.level) rows.row(i++) = level_row(kin, body);
  return rows;
}

/// Moments at the hinges of all that acts: of the energy with what holds the tail, its slope down.
/// Rotations do not commute: the rate of the rotation vector c at spin w is w - c x w / 2 near 0,
/// hence the second moment.
Eigen::VectorXd HeldRod::acting(const Eigen::VectorXd& angles) const {
  const Kinematics kin = at(angles);
  State state = rest_state(model_);
  state.q.tail(angles.size()) = angles;
  Eigen::VectorXd all = stiffness_force(model_, state.q).tail(angles.size());
  Vector6d held = ends_.tension * Vector6d::UnitX();
  if (multipliers_.size() > 0) {
    held(ends_.tail) += multipliers_.head(static_cast<Eigen::Index>(ends_.tail.size()));
    for (std::size_t i = 0; i < ends_.level.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(ends_.tail.size() + i);
      all += multipliers_[row] * level_row(kin, ends_.level[i]);
    }
  }
  const Eigen::Vector3d moment = held.tail<3>();
  return all + at_hinges(kin, held.head<3>(), moment + 0.5 * turned(kin).cross(moment));
}

/// Of the energy: the slope of what acts, with the other sign.
Eigen::MatrixXd HeldRod::hessian() const {
  const double by = 1e-5;  // rad: errors of 1e-10 of rounding and truncation
  Eigen::MatrixXd matrix(angles_.size(), angles_.size());
  for (Eigen::Index k = 0; k < angles_.size(); ++k) {
    Eigen::VectorXd off = angles_;
    off[k] -= by;
    matrix.col(k) = acting(off);
    off[k] += 2 * by;
    matrix.col(k) = (matrix.col(k) - acting(off)) / (2 * by);
  }
  return 0.5 * (matrix + matrix.transpose());
}

double HeldRod::settle() {
  constexpr int passes = 8;
  const Eigen::Index n = angles_.size();
  const Eigen::Index m = multipliers_.size();
  for (int pass = 0; pass < passes; ++pass) {
    const Kinematics kin = at(angles_);
    const Eigen::MatrixXd rows = jacobian(kin);
    Eigen::MatrixXd kkt(n + m, n + m);
    kkt << hessian(), -rows.transpose(), -rows, Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd right(n + m);
    right << acting(angles_), constraint(kin);
    const Eigen::VectorXd change = kkt.partialPivLu().solve(right);
    angles_ += change.head(n);
    multipliers_ += change.tail(m);
    if (change.head(n).lpNorm<Eigen::Infinity>() < 1e-9) break;
  }
  return acting(angles_).lpNorm<Eigen::Infinity>();
}

double HeldRod::least_stiffness(int let_go) const {
  const Eigen::MatrixXd held = jacobian(at(angles_));
  const Eigen::MatrixXd rows = held.topRows(held.rows() - let_go);
  const Eigen::MatrixXd all = rows.transpose().householderQr().householderQ();
  const Eigen::MatrixXd free = all.rightCols(all.cols() - rows.rows());
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(free.transpose() * hessian() * free,
                                                        Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

}  // namespace hagfish
