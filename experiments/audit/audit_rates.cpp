#include "experiments/audit/audit_rates.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/log/log_writer.hpp"

namespace hagfish {
namespace {

/// Forces and velocities are known as means from frame to frame, or at frames, so that a total
/// grows otherwise by some hundredths of its growth, and by up to a third where rows switch within
/// a frame. With another column's forces it is off by all of its growth or more. What bodies and
/// joints do cancels, so that growth is measured by the sum of its sizes.
constexpr double growth_tolerance = 0.7;
constexpr int frames_for_rates = 5;  // to tell

}  // namespace

RateAudit::RateAudit(const LogContents& log)
    : log_(log),
      position_(log.h5.rows("/trajectory/position")),
      tip_(log.h5.rows("/forces/tip")),
      thigmotaxis_(log.h5.rows("/mean/forces/thigmotaxis")),
      active_(log.h5.rows("/mean/forces/active")),
      head_(log.h5.rows("/mean/forces/head")),
      wall_(log.h5.rows("/mean/forces/wall")),
      passed_(log.model, log.resolved.scene.time.step) {
  const auto add = [&](const std::string& name, double (Passed::*through)() const) {
    growths_.push_back({name, through, log.h5.rows("/diagnostics/" + name)});
  };
  for (const char* name : {"work_tip", "work_thigmotaxis", "work_active"}) {
    add(name, &Passed::energy);
  }
  add("impulse_drag", &Passed::momentum);
  add("angular_impulse_drag", &Passed::angular_momentum);
  add("dissipated", &Passed::energy);
  add("angular_impulse_outside", &Passed::angular_momentum);
  outside_ = log.h5.rows("/diagnostics/impulse_outside");
  if (log.has_end()) tip_.row(log.begun) = tip_.row(log.begun - 1);  // up to the end
}

void RateAudit::Growth::compare(Eigen::Index frame, const Eigen::VectorXd& wanted, double passed) {
  const Eigen::VectorXd grew = total.row(frame) - total.row(frame - 1);
  off += (grew - wanted).norm();
  grown += std::max(grew.norm(), passed);
}

void RateAudit::see(const AuditedFrame& frame) {
  const Eigen::Index f = frame.index;
  if (f == 0) {
    return;
  }
  const double elapsed = log_.time[f] - log_.time[f - 1];
  const Eigen::VectorXd change = log_.q.row(f) - log_.q.row(f - 1);
  Eigen::VectorXd way(log_.model.nv());
  way << change.head<3>(),
      0.5 * elapsed * (log_.qdot.row(f) + log_.qdot.row(f - 1)).segment<3>(3).transpose(),
      change.tail(log_.model.nv() - root_dofs);
  const Eigen::Index bodies = log_.model.body_count();
  const Eigen::Matrix3Xd moved = (position_.row(f) - position_.row(f - 1)).reshaped(3, bodies);
  const Eigen::Vector3d tip = 0.5 * (tip_.row(f) + tip_.row(f - 1));
  passed_.see(elapsed, tip, head_.row(f), wall_.row(f));
  const Kinematics& kin = frame.observation.kin;
  const Eigen::Vector3d centre = centre_of_mass(log_.model, kin);
  Eigen::Vector3d drag = Eigen::Vector3d::Zero();
  Eigen::Vector3d drag_moment = drag;
  double drags = 0, moments = 0, dissipated = 0;
  for (int b = 0; b < bodies; ++b) {
    const PointMotion motion{elapsed * kin.twist.col(b).head<3>(), moved.col(b)};
    const auto [moment, force] = drag_on_body(log_.model, kin, b, motion);
    drag += force;
    drags += force.norm();
    const Eigen::Vector3d about = moment + (kin.centre.col(b) - centre).cross(force);
    drag_moment += about;
    moments += about.norm();
    dissipated += drag_power(log_.model, kin, b, motion, motion) / elapsed;
  }
  for (int k = root_dofs; k < log_.model.nv(); ++k) {
    dissipated += log_.model.hinges[k - root_dofs].damping * way[k] * way[k] / elapsed;
  }
  const auto one = [](double value) { return Eigen::VectorXd::Constant(1, value); };
  const Eigen::Vector3d tip_moved = moved.col(bodies - 1);
  growths_[0].compare(f, one(tip.dot(tip_moved)), tip.norm() * tip_moved.norm());
  const auto work = [&way](const auto& force) {
    return force.transpose().cwiseProduct(way).eval();
  };
  const Eigen::VectorXd thigmotaxis = work(thigmotaxis_.row(f)), active = work(active_.row(f));
  growths_[1].compare(f, one(thigmotaxis.sum()), thigmotaxis.lpNorm<1>());
  growths_[2].compare(f, one(active.sum()), active.lpNorm<1>());
  growths_[3].compare(f, drag, drags);
  growths_[4].compare(f, drag_moment, moments);
  growths_[5].compare(f, one(dissipated));
  see_outside(frame, centre, elapsed);
}

/// Of what pulls from outside all but the tip's force is known as a mean, and that one only acts
/// while a script forms the knot, or by a law of the run's own at any time.
void RateAudit::see_outside(const AuditedFrame& frame, const Eigen::Vector3d& centre,
                            double elapsed) {
  const Eigen::Index f = frame.index;
  const bool pulled = !(tip_.row(f - 1).isZero(0) && tip_.row(f).isZero(0));
  if (log_.own_law() ? !tip_.isZero(0)
                     : static_cast<Phase>(log_.phase[f - 1]) == Phase::form && pulled) {
    return;
  }
  double mass = 0;
  for (const Body& body : log_.model.bodies) {
    mass += body.mass;
  }
  const Eigen::Vector3d force = (head_.row(f) + wall_.row(f)).head<3>();
  const Eigen::VectorXd wanted = elapsed * (force + mass * log_.model.gravity);
  const Eigen::VectorXd grew = outside_.row(f) - outside_.row(f - 1);
  // What grows is a difference of totals.
  rebuilt_.compare(
      "/diagnostics/impulse_outside", grew, wanted,
      rebuilt_tolerance * std::max(outside_.cwiseAbs().maxCoeff(), passed_.momentum()));
  // Of the root's moment alone is known that arms move from frame to frame.
  const Eigen::VectorXd turning = head_.row(f) + wall_.row(f);
  growths_[6].compare(f, elapsed * moment_of_root(turning, frame.observation.kin, centre));
}

std::vector<Finding> RateAudit::findings() const {
  std::vector<Finding> findings{
      rebuilt_.finding("impulse from outside", "means of head clamp and plate, and gravity")};
  if (log_.q.rows() < frames_for_rates) {
    return findings;
  }
  for (const Growth& growth : growths_) {
    // What never grew must not be made to.
    const double largest =
        std::max(growth.total.cwiseAbs().maxCoeff(), (passed_.*growth.through)());
    const double share =
        share_of(growth.off, growth.grown, largest * static_cast<double>(log_.q.rows()));
    findings.push_back(judged_over({growth.name, share, growth_tolerance, "of its growth"},
                                   "as the forces and the motion from frame to frame make it"));
  }
  return findings;
}

}  // namespace hagfish
