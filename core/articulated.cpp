#include "core/articulated.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace hagfish {

void multiply(const Model& model, const Kinematics& kin, const Operator& op,
              const Eigen::VectorXd& v, Matrix6Xd& scratch, Eigen::VectorXd& product) {
  body_twists(model, kin, v, scratch);
  for (int b = 0; b < model.body_count(); ++b) {
    const Vector6d twist = scratch.col(b);
    scratch.col(b).noalias() = op.inertia[b] * twist;
  }
  generalised_force(model, kin, scratch, product);
  product += op.diagonal.cwiseProduct(v);
}

Eigen::VectorXd multiply(const Model& model, const Kinematics& kin, const Operator& op,
                         const Eigen::VectorXd& v) {
  Matrix6Xd scratch;
  Eigen::VectorXd product;
  multiply(model, kin, op, v, scratch, product);
  return product;
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
  // Columns of eight fill a vector register; the last two rows are zero.
  Eigen::Matrix<double, 8, 6> articulated = Eigen::Matrix<double, 8, 6>::Zero();
  for (int b = model.body_count() - 1; b >= 0; --b) {
    const Body& body = model.bodies[b];
    articulated.topRows<6>() += op.inertia[b];
    for (int k = body.first_dof + body.dofs - 1; k >= body.first_dof; --k) {
      const Vector6d axis = kin.axis.col(k);
      const Eigen::Matrix<double, 8, 1> u = articulated * axis;
      const double pivot = axis.dot(u.head<6>()) + op.diagonal[k];
      if (!(pivot > 0)) {
        throw std::domain_error("articulated inertia is not positive at velocity " +
                                std::to_string(k) + " (pivot " + std::to_string(pivot) + ")");
      }
      weighted_.col(k) = u.head<6>();
      inverse_pivot_[k] = 1 / pivot;
      const Vector6d share = inverse_pivot_[k] * u.head<6>();
      for (int i = 0; i < 6; ++i) {
        articulated.col(i) -= share[i] * u;
      }
    }
  }
}

void ArticulatedFactor::solve(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
                              const Eigen::VectorXd& joint, Eigen::VectorXd& v) const {
  v.resize(model.nv());
  Vector6d sum = Vector6d::Zero();
  for (int b = model.body_count() - 1; b >= 0; --b) {
    const Body& body = model.bodies[b];
    sum += wrench.col(b);
    for (int k = body.first_dof + body.dofs - 1; k >= body.first_dof; --k) {
      v[k] = (joint[k] + kin.axis.col(k).dot(sum)) * inverse_pivot_[k];
      sum -= weighted_.col(k) * v[k];
    }
  }
  Vector6d twist = Vector6d::Zero();
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    for (int k = body.first_dof; k < body.first_dof + body.dofs; ++k) {
      v[k] -= weighted_.col(k).dot(twist) * inverse_pivot_[k];
      twist += kin.axis.col(k) * v[k];
    }
  }
}

Eigen::VectorXd ArticulatedFactor::solve(const Model& model, const Kinematics& kin,
                                         const Matrix6Xd& wrench,
                                         const Eigen::VectorXd& joint) const {
  Eigen::VectorXd v;
  solve(model, kin, wrench, joint, v);
  return v;
}

void ArticulatedFactor::half_solve(const Model& model, const Kinematics& kin,
                                   RowColumns& columns) const {
  // Columns in panels that fill vector registers.
  constexpr int width = RowColumns::panel;
  auto& sum = columns.sum_;
  sum.setZero(6, columns.joint.cols());
  for (int b = model.body_count() - 1; b >= 0; --b) {
    for (int i = columns.newest_[b]; i >= 0; i = columns.loads_[i].next) {
      sum.col(columns.loads_[i].column) += columns.loads_[i].wrench;
    }
    const Body& body = model.bodies[b];
    for (int k = body.first_dof + body.dofs - 1; k >= body.first_dof; --k) {
      const double share = std::sqrt(inverse_pivot_[k]);
      const Vector6d axis = share * kin.axis.col(k);
      const Vector6d weighted = share * weighted_.col(k);
      for (Eigen::Index first = 0; first < sum.cols(); first += width) {
        Eigen::Array<double, 1, width> y =
            share * columns.joint.row(k).segment<width>(first).array();
        for (int i = 0; i < 6; ++i) {
          y += axis[i] * sum.row(i).segment<width>(first).array();
        }
        columns.joint.row(k).segment<width>(first) = y;
        for (int i = 0; i < 6; ++i) {
          sum.row(i).segment<width>(first).array() -= weighted[i] * y;
        }
      }
    }
  }
}

void RowColumns::reset(const Model& model, Eigen::Index m) {
  joint.setZero(model.nv(), (m + panel - 1) / panel * panel);
  loads_.clear();
  newest_.assign(model.body_count(), -1);
}

void RowColumns::load(int body, Eigen::Index column, const Vector6d& wrench) {
  loads_.push_back({wrench, column, newest_[body]});
  newest_[body] = static_cast<int>(loads_.size()) - 1;
}

}  // namespace hagfish
