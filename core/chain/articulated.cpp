#include "core/chain/articulated.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hagfish {

void multiply(const Model& model, const Kinematics& kin, const StepOperator& op,
              const Eigen::VectorXd& v, const Matrix6Xd& twist, Matrix6Xd& wrench,
              Eigen::VectorXd& product) {
  wrench.resize(6, model.body_count());
  for (int b = 0; b < model.body_count(); ++b) {
    const Eigen::Matrix<double, 8, 1> padded = op.inertia[b].columns * twist.col(b);
    wrench.col(b) = padded.head<6>();
  }
  generalised_force(model, kin, wrench, product);
  product += op.diagonal.cwiseProduct(v);
}

Eigen::VectorXd multiply(const Model& model, const Kinematics& kin, const StepOperator& op,
                         const Eigen::VectorXd& v) {
  Matrix6Xd wrench;
  Eigen::VectorXd product;
  multiply(model, kin, op, v, body_twists(model, kin, v), wrench, product);
  return product;
}

Eigen::MatrixXd dense(const Model& model, const Kinematics& kin, const StepOperator& op) {
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(model.nv(), model.nv());
  Matrix6d composite = Matrix6d::Zero();
  for (int b = model.body_count() - 1; b >= 0; --b) {
    const Body& body = model.bodies[b];
    composite += op.inertia[b].matrix();
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

void ArticulatedFactor::factorise(const Model& model, const Kinematics& kin, const StepOperator& op,
                                  std::span<const PrescribedVelocity> prescribed) {
  weighted_.resize(6, model.nv());
  coupling_.resize(model.nv());
  pivot_.resize(model.nv());
  inverse_pivot_.resize(model.nv());
  prescribed_.assign(prescribed.begin(), prescribed.end());
  auto next = prescribed_.rbegin();
  // Latency bounds this loop, so sums are in the order in which each waits least. `articulated` is
  // kept one rank-one update behind, u u' over the pivot of the dof behind. Products with it
  // subtract that update. So a dof waits for one pivot only, and not for the matrix.
  using Column = Eigen::Matrix<double, 8, 1>;
  Eigen::Matrix<double, 8, 6> articulated = Eigen::Matrix<double, 8, 6>::Zero();
  Column u = Column::Zero();
  double inverse = 0;   // inverse of the pivot behind
  double coupling = 0;  // with the dof behind
  for (int b = model.body_count() - 1; b >= 0; --b) {
    const Body& body = model.bodies[b];
    articulated += op.inertia[b].columns;
    for (int k = body.first_dof + body.dofs - 1; k >= body.first_dof; --k) {
      const Vector6d axis = kin.axis.col(k);
      const Column first = articulated.col(0) * axis[0] + articulated.col(1) * axis[1] +
                           articulated.col(2) * axis[2];
      const Column second = articulated.col(3) * axis[3] + articulated.col(4) * axis[4] +
                            articulated.col(5) * axis[5];
      const Column product = first + second;
      const double pivot =
          axis.dot(product.head<6>()) + op.diagonal[k] - coupling * coupling * inverse;
      if (!(pivot > 0)) {
        throw std::domain_error("articulated inertia is not positive at velocity " +
                                std::to_string(k) + " (pivot " + std::to_string(pivot) + ")");
      }
      const Column share = inverse * u;
      for (int i = 0; i < 6; ++i) articulated.col(i) -= u[i] * share;
      u = product - coupling * share;
      coupling = k == 0 ? 0 : kin.axis.col(k - 1).dot(u.head<6>());
      weighted_.col(k) = u.head<6>();
      coupling_[k] = coupling;
      pivot_[k] = pivot;
      if (next != prescribed_.rend() && next->dof == k) {
        inverse = 0;  // it does not give way, so all inertia behind it is felt before it
        ++next;
      } else {
        inverse = 1 / pivot;
      }
      inverse_pivot_[k] = inverse;
    }
  }
}

void ArticulatedFactor::solve(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
                              const Eigen::VectorXd& joint, Eigen::VectorXd& v, Matrix6Xd& twist,
                              Eigen::VectorXd& reaction) const {
  solve(model, kin, wrench, joint, prescribed_, v, twist, reaction);
}

void ArticulatedFactor::solve(const Model& model, const Kinematics& kin, const Matrix6Xd& wrench,
                              const Eigen::VectorXd& joint,
                              std::span<const PrescribedVelocity> prescribed, Eigen::VectorXd& v,
                              Matrix6Xd& twist, Eigen::VectorXd& reaction) const {
  v.resize(model.nv());
  twist.resize(6, model.body_count());
  const auto count = static_cast<Eigen::Index>(prescribed.size());
  reaction.resize(count);
  Eigen::Index next = count;
  // From the tail on, `sum` is the wrench on the bodies behind a dof, less what the dofs there take
  // up. From the head on, `moved` is the twist of the body before it. Both are kept one dof behind.
  // `coupling_`, the product of a dof's axis with the missing part, makes up for that. So each dof
  // waits for one velocity, and not for a vector with it.
  Vector6d sum = Vector6d::Zero();
  int last = 0;
  double velocity = 0;  // velocity of the dof `last`
  for (int b = model.body_count() - 1; b >= 0; --b) {
    const Body& body = model.bodies[b];
    sum += wrench.col(b);
    for (int k = body.first_dof + body.dofs - 1; k >= body.first_dof; --k) {
      const double force = joint[k] + kin.axis.col(k).dot(sum) - coupling_[last] * velocity;
      sum -= weighted_.col(last) * velocity;
      v[k] = force * inverse_pivot_[k];
      if (next > 0 && prescribed[next - 1].dof == k) {
        --next;
        reaction[next] = -force;
        v[k] = prescribed[next].value;
      }
      last = k;
      velocity = v[k];
    }
  }
  Vector6d moved = Vector6d::Zero();
  velocity = 0;
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    for (int k = body.first_dof; k < body.first_dof + body.dofs; ++k) {
      const double force = weighted_.col(k).dot(moved) + coupling_[k] * velocity;
      moved += kin.axis.col(last) * velocity;
      v[k] -= force * inverse_pivot_[k];
      if (next < count && prescribed[next].dof == k) {
        reaction[next] += force + pivot_[k] * v[k];
        ++next;
      }
      last = k;
      velocity = v[k];
    }
    twist.col(b) = moved + kin.axis.col(last) * velocity;
  }
}

Eigen::VectorXd ArticulatedFactor::solve(const Model& model, const Kinematics& kin,
                                         const Matrix6Xd& wrench,
                                         const Eigen::VectorXd& joint) const {
  Eigen::VectorXd v, reaction;
  Matrix6Xd twist;
  solve(model, kin, wrench, joint, v, twist, reaction);
  return v;
}

void ArticulatedFactor::half_solve(const Model& model, const Kinematics& kin,
                                   RowColumns& columns) const {
  using Panel = Eigen::Array<double, 1, RowColumns::panel>;
  auto& sum = columns.sum_;  // for each row, the wrench on the bodies behind, less what is taken up
  auto& y = columns.y_;      // what a dof takes up: S'sum, and its own force, over √pivot
  columns.set_widths();
  for (int b = model.body_count() - 1; b >= 0; --b) {
    for (int i = columns.newest_[b]; i >= 0; i = columns.loads_[i].next) {
      sum.col(columns.loads_[i].column).head<3>() += columns.loads_[i].moment;
      sum.col(columns.loads_[i].column).tail<3>() += columns.loads_[i].force;
    }
    const Body& body = model.bodies[b];
    for (int k = body.first_dof + body.dofs - 1; k >= body.first_dof; --k) {
      if (inverse_pivot_[k] == 0) {
        y.row(k).head(columns.width_[k]).setZero();
        continue;
      }
      const double share = std::sqrt(inverse_pivot_[k]);
      const Vector6d axis = share * kin.axis.col(k);
      const Vector6d weighted = share * weighted_.col(k);
      const bool loaded = columns.newest_joint_[k] >= 0;
      if (loaded) y.row(k).head(columns.width_[k]).setZero();
      for (int i = columns.newest_joint_[k]; i >= 0; i = columns.joint_loads_[i].next) {
        y(k, columns.joint_loads_[i].column) += share * columns.joint_loads_[i].force;
      }
      for (Eigen::Index first = 0; first < columns.width_[k]; first += RowColumns::panel) {
        Panel own = Panel::Zero();
        if (loaded) own = y.row(k).segment<RowColumns::panel>(first);
        for (int i = 0; i < 6; ++i) {
          own += axis[i] * sum.row(i).segment<RowColumns::panel>(first).array();
        }
        y.row(k).segment<RowColumns::panel>(first) = own;
        for (int i = 0; i < 6; ++i) {
          sum.row(i).segment<RowColumns::panel>(first).array() -= weighted[i] * own;
        }
      }
    }
  }
}

void RowColumns::reset(const Model& model, Eigen::Index m) {
  const Eigen::Index panels = (m + panel - 1) / panel;
  count_ = m;
  loads_.clear();
  joint_loads_.clear();
  newest_.assign(model.body_count(), -1);
  newest_joint_.assign(model.nv(), -1);
  end_.assign(panels, 0);
  y_.resize(model.nv(), panels * panel);
  sum_.setZero(6, panels * panel);
}

void RowColumns::load(const Model& model, int body, Eigen::Index column,
                      const Eigen::Vector3d& moment, const Eigen::Vector3d& force) {
  loads_.push_back({moment, force, column, newest_[body]});
  newest_[body] = static_cast<int>(loads_.size()) - 1;
  extend(column, model.bodies[body].first_dof + model.bodies[body].dofs);
}

void RowColumns::load_joint(Eigen::Index dof, Eigen::Index column, double force) {
  joint_loads_.push_back({force, column, newest_joint_[dof]});
  newest_joint_[dof] = static_cast<int>(joint_loads_.size()) - 1;
  extend(column, dof + 1);
}

void RowColumns::extend(Eigen::Index column, Eigen::Index end) {
  end_[column / panel] = std::max(end_[column / panel], end);
}

void RowColumns::set_widths() {
  width_.assign(y_.rows(), 0);
  for (std::size_t p = 0; p < end_.size(); ++p) {
    std::fill_n(width_.begin(), end_[p], (static_cast<Eigen::Index>(p) + 1) * panel);
  }
}

void RowColumns::gram(Eigen::MatrixXd& A) const {
  A.resize(count_, count_);
  for (Eigen::Index p = 0; p < count_; p += panel) {
    for (Eigen::Index q = 0; q <= p; q += panel) {
      const Eigen::Index rows = std::min<Eigen::Index>(panel, count_ - q);
      const Eigen::Index cols = std::min<Eigen::Index>(panel, count_ - p);
      const Eigen::Index end = std::min(end_[q / panel], end_[p / panel]);
      const Tile all = tile_product(&y_(0, q), y_.outerStride(), &y_(0, p), y_.outerStride(), end);
      A.block(q, p, rows, cols) = all.topLeftCorner(rows, cols);
      A.block(p, q, cols, rows) = all.topLeftCorner(rows, cols).transpose();
    }
  }
}

}  // namespace hagfish
