#include "mujoco_ref/agreement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <vector>

#include "core/chain/dynamics.hpp"
#include "core/chain/kinematics.hpp"
#include "mujoco_ref/mirror.hpp"

namespace hagfish {
namespace {

using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajorXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Times the condition of M: seen in q̈ of 2 to 100 bodies, mass ratios of 0.01 to 1e4: a tenth.
constexpr double rounding = std::numeric_limits<double>::epsilon();

double even(std::mt19937& random, double size) {
  return size * (2 * static_cast<double>(random()) / 0x1p32 - 1);
}

/// Largest |x - y| over the largest |y|, both in the units of `scale`.
double difference(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                  const Eigen::VectorXd& scale) {
  const double size = y.cwiseProduct(scale).lpNorm<Eigen::Infinity>();
  const double off = (x - y).cwiseProduct(scale).lpNorm<Eigen::Infinity>();
  return off == 0 ? 0 : off / size;
}

/// Forces on the right of M q̈ = -bias that depend on the state alone, and M q̈'s q̈.
struct Dynamics {
  Eigen::MatrixXd mass;
  Eigen::VectorXd bias;
  Eigen::VectorXd acceleration;
};

Dynamics core_dynamics(const Model& model, const State& state, const Kinematics& kin, Head head) {
  const StepOperator op{body_inertias(model, kin), Eigen::VectorXd::Zero(model.nv())};
  Eigen::VectorXd joint = stiffness_force(model, state.q);
  for (int k = root_dofs; k < model.nv(); ++k) {
    joint[k] -= model.hinges[k - root_dofs].damping * state.qdot[k];
  }
  const Matrix6Xd wrench = gravity_wrench(model, kin) - bias_wrench(model, kin, motion_of(kin));
  Dynamics dynamics{dense(model, kin, op), -(generalised_force(model, kin, wrench) + joint), {}};
  std::vector<PrescribedVelocity> prescribed;  // Eq. 3 for accelerations: the clamped head has none
  for (int k = 0; head == Head::clamped && k < root_dofs; ++k) prescribed.push_back({k, 0});
  ArticulatedFactor factor;
  factor.factorise(model, kin, op, prescribed);
  dynamics.acceleration = factor.solve(model, kin, wrench, joint);
  return dynamics;
}

Dynamics mujoco_dynamics(const mjModel& m, const mjData& d) {
  RowMajorXd mass(m.nv, m.nv);
  mj_fullM(&m, mass.data(), d.qM);
  const auto vector = [&](const mjtNum* values) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values, m.nv));
  };
  return {mass, vector(d.qfrc_bias) - vector(d.qfrc_passive), vector(d.qacc)};
}

void compare_bodies(const Model& model, const Kinematics& kin, const mjData& d, Agreement& result) {
  for (int b = 0; b < model.body_count(); ++b) {
    const Eigen::Vector3d origin(d.xpos + 3 * (b + 1));
    const Eigen::Vector3d centre(d.xipos + 3 * (b + 1));
    const Eigen::Map<const RowMajor3d> rotation(d.xmat + 9 * (b + 1));
    result.position =
        std::max({result.position, (origin - kin.origin.col(b)).norm() / model.length(),
                  (centre - kin.centre.col(b)).norm() / model.length()});
    result.orientation =
        std::max(result.orientation, (rotation - kin.rotation[b]).lpNorm<Eigen::Infinity>());
  }
}

}  // namespace

double acceleration_bound(double condition) {
  return std::max(agreement_bound.acceleration, rounding * condition);
}

Agreement agreement(const Model& model, const State& state, MujocoModel& mirror) {
  const Head head = head_of(*mirror.model(), model);
  const Kinematics kin = kinematics(model, state);
  const Dynamics core = core_dynamics(model, state, kin, head);
  mirror.model()->opt.disableflags |= mjDSBL_CONSTRAINT;
  set_state(model, state, mirror);
  mj_forward(mirror.model(), mirror.data());
  const Dynamics mujoco = mujoco_dynamics(*mirror.model(), *mirror.data());

  Agreement result;
  compare_bodies(model, kin, *mirror.data(), result);
  const int n = mirror.model()->nv;
  const Eigen::VectorXd scale = mujoco.mass.diagonal().cwiseSqrt();
  const Eigen::VectorXd inverse = scale.cwiseInverse();
  const Eigen::MatrixXd unit = inverse.asDiagonal() * mujoco.mass * inverse.asDiagonal();
  result.condition = 1 / Eigen::LLT<Eigen::MatrixXd>(unit).rcond();
  result.mass = (inverse.asDiagonal() * (core.mass.bottomRightCorner(n, n) - mujoco.mass) *
                 inverse.asDiagonal())
                    .cwiseAbs()
                    .maxCoeff();
  result.bias = difference(core.bias.tail(n), mujoco.bias, inverse);
  result.acceleration = difference(core.acceleration.tail(n), mujoco.acceleration, scale);
  return result;
}

Agreement worst(const Agreement& a, const Agreement& b) {
  return {std::max(a.position, b.position),
          std::max(a.orientation, b.orientation),
          std::max(a.mass, b.mass),
          std::max(a.bias, b.bias),
          std::max(a.acceleration, b.acceleration),
          std::max(a.condition, b.condition)};
}

State drawn_state(std::mt19937& random, const Model& model, Head head, double angle, double spin) {
  State state = rest_state(model);
  for (double& value : state.q.tail(model.nq() - root_dofs - 1)) value = even(random, angle);
  for (double& value : state.qdot.tail(model.nv() - root_dofs)) value = even(random, spin);
  if (head == Head::free) {
    for (double& value : state.q.head<3>()) value = even(random, model.length());
    for (double& value : state.q.segment<4>(3)) value = even(random, 1);
    state.q.segment<4>(3).normalize();
    for (double& value : state.qdot.head<root_dofs>()) value = even(random, spin);
  }
  return state;
}

}  // namespace hagfish
