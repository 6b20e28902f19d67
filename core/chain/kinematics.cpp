#include "core/chain/kinematics.hpp"

namespace hagfish {
namespace {

/// Turns `frame` about its column `axis`: only the other two change, which is cheaper than a
/// product of matrices, and less rounding.
template <int axis>
void turn(double cosine, double sine, Eigen::Matrix3d& frame) {
  constexpr int b = (axis + 1) % 3;
  constexpr int c = (axis + 2) % 3;
  const Eigen::Vector3d before = frame.col(b);
  frame.col(b) = cosine * before + sine * frame.col(c);
  frame.col(c) = cosine * frame.col(c) - sine * before;
}

void turn(Axis axis, double angle, Eigen::Matrix3d& frame) {
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  switch (axis) {
    case Axis::x:
      return turn<0>(cosine, sine, frame);
    case Axis::y:
      return turn<1>(cosine, sine, frame);
    case Axis::z:
      return turn<2>(cosine, sine, frame);
  }
}

}  // namespace

void update_positions(const Model& model, const Eigen::VectorXd& q, Kinematics& kin) {
  const int n = model.body_count();
  kin.rotation.resize(n);
  kin.origin.resize(3, n);
  kin.centre.resize(3, n);
  kin.axis.resize(6, model.nv());

  // Hinge axes are kept as directions here and become twists once O is known.
  for (int b = 0; b < n; ++b) {
    const Body& body = model.bodies[b];
    if (b == 0) {
      kin.rotation[0] = root_orientation(q).toRotationMatrix();
      kin.origin.col(0) = q.head<3>();
    } else {
      const Eigen::Matrix3d& parent = kin.rotation[b - 1];
      kin.origin.col(b) = kin.origin.col(b - 1) + model.bodies[b - 1].length * parent.col(0);
      Eigen::Matrix3d frame = parent;
      for (int k = body.first_dof; k < body.first_dof + body.dofs; ++k) {
        const Axis axis = model.hinges[k - root_dofs].axis;
        kin.axis.col(k).head<3>() = frame.col(static_cast<int>(axis));
        turn(axis, q[k + 1], frame);
      }
      kin.rotation[b] = frame;
    }
    kin.centre.col(b) = kin.origin.col(b) + 0.5 * body.length * kin.rotation[b].col(0);
  }

  kin.reference = kin.centre.col(n / 2);
  const Eigen::Vector3d root = kin.origin.col(0) - kin.reference;
  kin.axis.leftCols<3>() << Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity();
  for (int k = 0; k < 3; ++k) {
    kin.axis.col(3 + k) = rotation_axis(kin.rotation[0].col(k), root);
  }
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Eigen::Vector3d direction = kin.axis.col(k).head<3>();
    kin.axis.col(k) =
        rotation_axis(direction, kin.origin.col(model.hinges[k - root_dofs].body) - kin.reference);
  }
}

void update_velocities(const Model& model, const Eigen::VectorXd& qdot, Kinematics& kin) {
  update_velocities(model, qdot, qdot, kin);
}

void update_velocities(const Model& model, const Eigen::VectorXd& moved,
                       const Eigen::VectorXd& felt, Kinematics& kin) {
  const int n = model.body_count();
  kin.twist.resize(6, n);
  kin.bias_twist.resize(6, n);
  Vector6d twist = kin.axis.leftCols<root_dofs>() * moved.head<root_dofs>();
  // The root's translation axes stand still; its rotation axes turn and move with the body.
  Vector6d bias = cross_motion(twist, Vector6d(kin.axis.middleCols<3>(3) * felt.segment<3>(3)));
  kin.twist.col(0) = twist;
  kin.bias_twist.col(0) = bias;
  for (int b = 1; b < n; ++b) {
    const Body& body = model.bodies[b];
    for (int k = body.first_dof; k < body.first_dof + body.dofs; ++k) {
      const Vector6d turn = kin.axis.col(k) * moved[k];
      bias += cross_motion(twist, Vector6d(kin.axis.col(k) * felt[k]));
      twist += turn;
    }
    kin.twist.col(b) = twist;
    kin.bias_twist.col(b) = bias;
  }
  centre_velocities(kin, kin.twist, kin.centre_velocity);
}

Kinematics kinematics(const Model& model, const State& state) {
  Kinematics kin;
  update_positions(model, state.q, kin);
  update_velocities(model, state.qdot, kin);
  return kin;
}

Matrix6Xd body_twists(const Model& model, const Kinematics& kin, const Eigen::VectorXd& v) {
  Matrix6Xd twist;
  body_twists(model, kin, v, twist);
  return twist;
}

void body_twists(const Model& model, const Kinematics& kin, const Eigen::VectorXd& v,
                 Matrix6Xd& twist) {
  twist.resize(6, model.body_count());
  Vector6d sum = Vector6d::Zero();
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    for (int k = body.first_dof; k < body.first_dof + body.dofs; ++k) {
      sum += kin.axis.col(k) * v[k];
    }
    twist.col(b) = sum;
  }
}

Eigen::Matrix3Xd centre_velocities(const Kinematics& kin, const Matrix6Xd& twist) {
  Eigen::Matrix3Xd velocity;
  centre_velocities(kin, twist, velocity);
  return velocity;
}

void centre_velocities(const Kinematics& kin, const Matrix6Xd& twist, Eigen::Matrix3Xd& velocity) {
  velocity.resize(3, twist.cols());
  for (int b = 0; b < static_cast<int>(twist.cols()); ++b) {
    velocity.col(b) = point_velocity(twist.col(b), kin.centre_offset(b));
  }
}

Eigen::VectorXd generalised_force(const Model& model, const Kinematics& kin,
                                  const Matrix6Xd& wrench) {
  Eigen::VectorXd force;
  generalised_force(model, kin, wrench, force);
  return force;
}

void generalised_force(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
                       Eigen::VectorXd& force) {
  force.resize(model.nv());
  Vector6d sum = Vector6d::Zero();
  for (int b = model.body_count() - 1; b >= 0; --b) {
    const Body& body = model.bodies[b];
    sum += wrench.col(b);
    for (int k = body.first_dof; k < body.first_dof + body.dofs; ++k) {
      force[k] = kin.axis.col(k).dot(sum);
    }
  }
}

}  // namespace hagfish
