#include "core/chain/joint_moments.hpp"

namespace hagfish {

std::vector<Eigen::Matrix3d> axes_of_joints(const Kinematics& kin) {
  std::vector<Eigen::Matrix3d> axes(kin.rotation.size());
  if (axes.empty()) return axes;
  Eigen::Vector4d before = Eigen::Quaterniond(kin.rotation.front()).coeffs();
  for (std::size_t b = 0; b < axes.size(); ++b) {
    Eigen::Vector4d behind = Eigen::Quaterniond(kin.rotation[b]).coeffs();
    if (behind.dot(before) < 0) behind = -behind;  // the same rotation
    const Eigen::Quaterniond halfway(Eigen::Vector4d((before + behind).normalized()));
    axes[b] = halfway.toRotationMatrix().transpose();
    before = behind;
  }
  return axes;
}

void add_moments(const Kinematics& kin, const Matrix6Xd& wrench,
                 const std::vector<Eigen::Matrix3d>& axes, Eigen::Matrix3Xd& moment) {
  Eigen::Vector3d about_reference = Eigen::Vector3d::Zero(), force = about_reference;
  for (Eigen::Index b = wrench.cols() - 1; b >= 0; --b) {
    about_reference += wrench.col(b).head<3>();
    force += wrench.col(b).tail<3>();
    const Eigen::Vector3d lever = kin.origin.col(b) - kin.reference;
    moment.col(b) += axes[b] * (about_reference - lever.cross(force));
  }
}

void add_hinge_moments(const Model& model, const Kinematics& kin, const Eigen::VectorXd& torque,
                       const std::vector<Eigen::Matrix3d>& axes, Eigen::Matrix3Xd& moment) {
  for (Eigen::Index k = root_dofs; k < torque.size(); ++k) {
    if (torque[k] == 0) continue;
    const int body = model.hinges[k - root_dofs].body;
    moment.col(body) += torque[k] * (axes[body] * kin.axis.col(k).head<3>());
  }
}

Eigen::Matrix3Xd joint_curvature(const Model& model, const Kinematics& kin) {
  Eigen::Matrix3Xd curvature = Eigen::Matrix3Xd::Zero(3, model.body_count());
  for (int b = 1; b < model.body_count(); ++b) {
    const Eigen::AngleAxisd turn(kin.rotation[b - 1].transpose() * kin.rotation[b]);
    curvature.col(b) = turn.angle() / hinge_span(model, b) * turn.axis();
  }
  return curvature;
}

}  // namespace hagfish
