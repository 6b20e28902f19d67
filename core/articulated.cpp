#include "core/articulated.hpp"

#include <stdexcept>
#include <string>

namespace hagfish {

Eigen::VectorXd multiply(const Model& model, const Kinematics& kin, const Operator& op,
                         const Eigen::VectorXd& v) {
  const Matrix6Xd twist = body_twists(model, kin, v);
  Matrix6Xd wrench(6, model.body_count());
  for (int b = 0; b < model.body_count(); ++b) {
    wrench.col(b) = op.inertia[b] * twist.col(b);
  }
  return generalised_force(model, kin, wrench) + op.diagonal.cwiseProduct(v);
}

Eigen::MatrixXd dense(const Model& model, const Kinematics& kin, const Operator& op) {
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(model.nv(), model.nv());
  Matrix6d composite = Matrix6d::Zero();
  for (int b = model.body_count() - 1; b >= 0; --b) {
    const Body& body = model.bodies[b];
    composite += op.inertia[b];
    const int end = body.first_dof + body.dofs;
    for (int k = body.first_dof; k < end; ++k) {
      const Vector6d momentum = composite * kin.axis.col(k);
      for (int i = 0; i < end; ++i) {
        h(i, k) = kin.axis.col(i).dot(momentum);
        h(k, i) = h(i, k);
      }
    }
  }
  h.diagonal() += op.diagonal;
  return h;
}

void ArticulatedFactor::factorise(const Model& model, const Kinematics& kin, const Operator& op) {
  weighted_.resize(6, model.nv());
  inverse_pivot_.resize(model.nv());
  Matrix6d articulated = Matrix6d::Zero();
  for (int b = model.body_count() - 1; b >= 0; --b) {
    const Body& body = model.bodies[b];
    articulated += op.inertia[b];
    for (int k = body.first_dof + body.dofs - 1; k >= body.first_dof; --k) {
      const Vector6d u = articulated * kin.axis.col(k);
      const double pivot = kin.axis.col(k).dot(u) + op.diagonal[k];
      if (!(pivot > 0)) {
        throw std::domain_error("articulated inertia is not positive at velocity " +
                                std::to_string(k) + " (pivot " + std::to_string(pivot) + ")");
      }
      weighted_.col(k) = u;
      inverse_pivot_[k] = 1 / pivot;
      articulated -= (u * inverse_pivot_[k]) * u.transpose();
    }
  }
}

void ArticulatedFactor::solve(const Model& model, const Kinematics& kin, ColumnSet& columns) const {
  const Eigen::Index m = columns.joint.cols();
  using Block = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>;
  Block sum = Block::Zero(6, m);
  for (int b = model.body_count() - 1; b >= 0; --b) {
    const Body& body = model.bodies[b];
    sum += columns.body.middleRows<6>(6 * b);
    for (int k = body.first_dof + body.dofs - 1; k >= body.first_dof; --k) {
      auto row = columns.joint.row(k);
      row.noalias() += kin.axis.col(k).transpose().lazyProduct(sum);
      row *= inverse_pivot_[k];
      for (int i = 0; i < 6; ++i) {
        sum.row(i) -= weighted_(i, k) * row;
      }
    }
  }
  Block twist = Block::Zero(6, m);
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    for (int k = body.first_dof; k < body.first_dof + body.dofs; ++k) {
      auto row = columns.joint.row(k);
      const Vector6d scaled = weighted_.col(k) * inverse_pivot_[k];
      row.noalias() -= scaled.transpose().lazyProduct(twist);
      for (int i = 0; i < 6; ++i) {
        twist.row(i) += kin.axis(i, k) * row;
      }
    }
    columns.body.middleRows<6>(6 * b) = twist;
  }
}

Eigen::VectorXd ArticulatedFactor::solve(const Model& model, const Kinematics& kin,
                                         const Matrix6Xd& wrench,
                                         const Eigen::VectorXd& joint) const {
  ColumnSet columns;
  columns.joint = joint;
  columns.body = wrench.reshaped();
  solve(model, kin, columns);
  return columns.joint.col(0);
}

}  // namespace hagfish
