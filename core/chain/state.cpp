#include "core/chain/state.hpp"

#include "core/chain/sines.hpp"

namespace hagfish {

State rest_state(const Model& model) {
  State state{Eigen::VectorXd::Zero(model.nq()), Eigen::VectorXd::Zero(model.nv())};
  state.q[3] = 1;
  return state;
}

void advance(const Eigen::VectorXd& q0, const Eigen::VectorXd& qdot, double h, Eigen::VectorXd& q) {
  q = q0;
  q.head<3>() += h * qdot.head<3>();
  const Eigen::Vector3d turn = h * qdot.segment<3>(3);
  const double angle = turn.norm();
  if (angle > 0) {
    const SineCosine half = sine_and_cosine(0.5 * angle);
    const Eigen::Vector3d axis = turn / angle;
    Eigen::Quaterniond rotation;
    rotation.w() = half.cosine;
    rotation.vec() = half.sine * axis;
    const Eigen::Quaterniond turned = (root_orientation(q0) * rotation).normalized();
    q.segment<4>(3) << turned.w(), turned.x(), turned.y(), turned.z();
  }
  const Eigen::Index hinges = qdot.size() - root_dofs;
  q.tail(hinges) += h * qdot.tail(hinges);
}

Eigen::VectorXd advance(const Eigen::VectorXd& q0, const Eigen::VectorXd& qdot, double h) {
  Eigen::VectorXd q;
  advance(q0, qdot, h, q);
  return q;
}

}  // namespace hagfish
