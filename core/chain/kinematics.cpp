#include "core/chain/kinematics.hpp"

#include "core/chain/sines.hpp"

namespace hagfish {
namespace {

/// The axes of a body: three vectors, which stay in registers where a matrix goes through memory.
struct Frame {
  Eigen::Vector3d x, y, z;
};

/// Turns two axes of a frame about the third: cheaper than a product of matrices, and less
/// rounding.
void turn(double sine, double cosine, Eigen::Vector3d& b, Eigen::Vector3d& c) {
  const Eigen::Vector3d before = b;
  b = cosine * before + sine * c;
  c = cosine * c - sine * before;
}

/// Turns `frame` about one of its axes, and returns that.
Eigen::Vector3d turn(Axis axis, double sine, double cosine, Frame& frame) {
  switch (axis) {
    case Axis::x:
      turn(sine, cosine, frame.y, frame.z);
      return frame.x;
    case Axis::y:
      turn(sine, cosine, frame.z, frame.x);
      return frame.y;
    case Axis::z:
      turn(sine, cosine, frame.x, frame.y);
      return frame.z;
  }
  return {};
}

/// The axes of bodies and hinges.
void update_axes(const Model& model, const Eigen::VectorXd& q, Kinematics& kin) {
  const int n = model.body_count();
  kin.rotation.resize(n);
  kin.axis.resize(6, model.nv());

  // Hinge axes are kept as directions here and become twists once O is known.
  const Eigen::Matrix3d root_frame = root_orientation(q).toRotationMatrix();
  Frame frame{root_frame.col(0), root_frame.col(1), root_frame.col(2)};
  sines_and_cosines(q.tail(model.nv() - root_dofs), kin.sine, kin.cosine);
  for (int b = 0; b < n; ++b) {
    const Body& body = model.bodies[b];
    for (int k = b == 0 ? root_dofs : body.first_dof; k < body.first_dof + body.dofs; ++k) {
      const int hinge = k - root_dofs;
      kin.axis.col(k).head<3>() =
          turn(model.hinges[hinge].axis, kin.sine[hinge], kin.cosine[hinge], frame);
    }
    kin.rotation[b].col(0) = frame.x;
    kin.rotation[b].col(1) = frame.y;
    kin.rotation[b].col(2) = frame.z;
  }
}

/// Places of bodies and hinges, by their axes and the place of the root.
void update_places(const Model& model, const Eigen::Vector3d& root, Kinematics& kin) {
  const int n = model.body_count();
  kin.origin.resize(3, n);
  kin.centre.resize(3, n);
  Eigen::Vector3d origin = root;
  for (int b = 0; b < n; ++b) {
    const double length = model.bodies[b].length;
    const Eigen::Vector3d along = kin.rotation[b].col(0);
    kin.origin.col(b) = origin;
    kin.centre.col(b) = origin + 0.5 * length * along;
    origin += length * along;
  }

  kin.reference = kin.centre.col(n / 2);
  kin.axis.leftCols<root_dofs>() << Eigen::Matrix3d::Zero(), kin.rotation[0],
      Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero();
  for (int k = 3; k < model.nv(); ++k) {  // all but the root's translations
    const int body = k < root_dofs ? 0 : model.hinges[k - root_dofs].body;
    const Eigen::Vector3d direction = kin.axis.col(k).head<3>();
    const Eigen::Vector3d offset = kin.origin.col(body) - kin.reference;
    kin.axis.col(k).tail<3>() = offset.cross(direction);
  }
}

}  // namespace

void update_positions(const Model& model, const Eigen::VectorXd& q, Kinematics& kin) {
  update_axes(model, q, kin);
  update_places(model, q.head<3>(), kin);
}

void place_centre(const Model& model, const Eigen::Vector3d& centre, Eigen::VectorXd& q,
                  Kinematics& kin) {
  update_axes(model, q, kin);
  Eigen::Vector3d end = Eigen::Vector3d::Zero();  // end of the body, from the root
  Eigen::Vector3d moment = end;
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    const Eigen::Vector3d half = 0.5 * body.length * kin.rotation[b].col(0);
    moment += body.mass * (end + half);
    end += 2 * half;
  }
  q.head<3>() = centre - moment / model.mass();
  update_places(model, q.head<3>(), kin);
}

Eigen::Vector3d centre_of_mass(const Model& model, const Kinematics& kin) {
  return mean_by_mass(model, kin.centre);
}

Eigen::Vector3d mean_by_mass(const Model& model, const Eigen::Matrix3Xd& of) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (int b = 0; b < model.body_count(); ++b) moment += model.bodies[b].mass * of.col(b);
  return moment / model.mass();
}

void update_velocities(const Model& model, const Eigen::VectorXd& qdot, Kinematics& kin) {
  update_velocities(model, qdot, qdot, kin);
}

void update_velocities(const Model& model, const Eigen::VectorXd& step_velocity,
                       const Eigen::VectorXd& mean_velocity, Kinematics& kin) {
  const int n = model.body_count();
  kin.twist.resize(6, n);
  kin.bias_twist.resize(6, n);
  // Halves of twists stay in registers, where vectors of six would go through memory.
  const Vector6d root = kin.axis.leftCols<root_dofs>() * step_velocity.head<root_dofs>();
  Eigen::Vector3d spin = root.head<3>(), velocity = root.tail<3>();
  Eigen::Vector3d spin_bias = Eigen::Vector3d::Zero(), velocity_bias = spin_bias;
  // A motion that the twist so far carries along (Featherstone 2008, 2.9).
  const auto carry = [&](const Eigen::Vector3d& turn, const Eigen::Vector3d& shift, double rate) {
    spin_bias += rate * spin.cross(turn);
    velocity_bias += rate * (spin.cross(shift) + velocity.cross(turn));
  };
  // The root's translation axes stand still; its rotation axes turn and move with the body.
  const Vector6d turning = kin.axis.middleCols<3>(3) * mean_velocity.segment<3>(3);
  carry(turning.head<3>(), turning.tail<3>(), 1);
  for (int b = 0; b < n; ++b) {
    const Body& body = model.bodies[b];
    for (int k = b == 0 ? root_dofs : body.first_dof; k < body.first_dof + body.dofs; ++k) {
      const Eigen::Vector3d axis = kin.axis.col(k).head<3>(), arm = kin.axis.col(k).tail<3>();
      carry(axis, arm, mean_velocity[k]);
      spin += step_velocity[k] * axis;
      velocity += step_velocity[k] * arm;
    }
    kin.twist.col(b).head<3>() = spin;
    kin.twist.col(b).tail<3>() = velocity;
    kin.bias_twist.col(b).head<3>() = spin_bias;
    kin.bias_twist.col(b).tail<3>() = velocity_bias;
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
  Eigen::Vector3d spin = Eigen::Vector3d::Zero(), velocity = spin;  // in registers, as above
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    for (int k = body.first_dof; k < body.first_dof + body.dofs; ++k) {
      spin += v[k] * kin.axis.col(k).head<3>();
      velocity += v[k] * kin.axis.col(k).tail<3>();
    }
    twist.col(b).head<3>() = spin;
    twist.col(b).tail<3>() = velocity;
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
