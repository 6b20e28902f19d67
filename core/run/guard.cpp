#include "core/run/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/contact/obstacles.hpp"
#include "core/step/look_ahead.hpp"
#include "core/step/rows/dual_problem.hpp"
#include "core/step/rows/eq6_rows.hpp"

namespace hagfish {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Reports what happened and what to do about it. If the run continues, also whether it can be
/// used.
Status tell(Outcome outcome, GuardAction action, Watch& watch, std::vector<std::string>& warnings,
            const std::string& what, const std::string& use, const std::string& remedy) {
  const std::string message = action == GuardAction::stop ? what + "; " : what + ". " + use + "; ";
  return report(outcome, message + remedy, action, watch, warnings);
}

/// tell() where the run continues in any case.
void warn(Outcome outcome, Watch& watch, std::vector<std::string>& warnings,
          const std::string& what, const std::string& use, const std::string& remedy) {
  std::ignore = tell(outcome, GuardAction::warn, watch, warnings, what, use, remedy);
}

/// Names the bodies or obstacle at the deepest overlap of a state.
std::string deepest_overlap(const Model& model, const Observation& observation) {
  double least = 0;
  std::string name = "none";
  const auto of_obstacle = [&model](int body, int obstacle) {
    return fmt::format("body {} and the {}", body, model.obstacles[obstacle].name);
  };
  const ContactSet& found = observation.contact;
  for (const auto* contacts : {&found.contacts, &found.on_obstacles, &found.near_pairs}) {
    for (const Contact& contact : *contacts) {
      if (contact.gap < least) {
        least = contact.gap;
        name = contact.obstacle >= 0
                   ? of_obstacle(contact.body_a(), contact.obstacle)
                   : fmt::format("bodies {} and {}", contact.body_a(), contact.body_b());
      }
    }
  }
  visit_plane_gaps(model, observation.kin, [&](const PlaneGap& at) {
    if (at.gap < least) {
      least = at.gap;
      name = of_obstacle(at.body, at.obstacle);
    }
  });
  return name;
}

/// The joint that is furthest past its limit.
std::string furthest_limit(const Model& model, const State& state) {
  Eigen::Index worst = root_dofs;
  double most = 0;
  for (Eigen::Index k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    const double over = std::max(hinge.lower - state.q[k + 1], state.q[k + 1] - hinge.upper);
    if (over > most) {
      most = over;
      worst = k;
    }
  }
  const BendingCone* bent = nullptr;
  for (const BendingCone& cone : model.cones) {
    const double over = past_cone(cone, state.q);
    if (over > most) {
      most = over;
      bent = &cone;
    }
  }
  return bent == nullptr ? dof_name(model, static_cast<int>(worst)) : cone_joint_name(model, *bent);
}

/// The rows whose forces resist row i most, at most three, strongest first.
std::vector<const Row*> opponents(const Model& model, const Kinematics& kin,
                                  const StepSolution& step, Eigen::Index i) {
  const Eigen::MatrixXd A = whole_dual(model, kin, step.system, step.rows).A;
  std::vector<std::pair<double, Eigen::Index>> effect;  // on the row's velocity
  for (Eigen::Index j = 0; j < A.rows(); ++j) {
    if (j != i && A(i, j) * step.lambda[j] < 0) effect.emplace_back(A(i, j) * step.lambda[j], j);
  }
  std::sort(effect.begin(), effect.end());
  std::vector<const Row*> rows;
  for (std::size_t k = 0; k < std::min<std::size_t>(3, effect.size()); ++k) {
    rows.push_back(&step.rows[static_cast<std::size_t>(effect[k].second)]);
  }
  return rows;
}

/// Advice for a row of Eq. 6 at its cap, by the row that holds it back most.
std::string cure_of_cap(const Row& row, const std::vector<const Row*>& against) {
  const RowKind kind = against.empty() ? RowKind::contact : against[0]->kind;
  if (kind == RowKind::thigmotaxis && against[0]->command == row.command) {
    const double angle = std::acos(
        std::min(1.0, std::abs(row.points().direction.dot(against[0]->points().direction))));
    return fmt::format(
        "its strands cross at only {:.2g} deg, so it cannot have both speeds: try "
        "controller.eq6_slip = \"shape\"",
        angle / degree);
  }
  if (kind == RowKind::limit) {
    return "joint limits block the motion: try a lower speed or a larger model.limit_scale";
  }
  if (kind == RowKind::obstacle) {
    return "an obstacle is in the way: try a larger controller.release_at";
  }
  return "try a lower speed or a higher cap";
}

}  // namespace

Status report(Outcome outcome, const std::string& message, GuardAction action, Watch& watch,
              std::vector<std::string>& warnings) {
  if (action == GuardAction::stop) return {outcome, message};
  if (!watch.has_warned(outcome)) {
    watch.warned.set(static_cast<std::size_t>(outcome));
    warnings.push_back(message);
  }
  return {};
}

Status guard_speed(const Eigen::Matrix3Xd& centre_velocity, const Eigen::Vector3d& observer,
                   const Scene& scene) {
  const GuardSettings& guard = scene.guard;
  const double farthest = most_path_samples * scene.constraints.stride;
  for (Eigen::Index b = 0; b < centre_velocity.cols(); ++b) {
    const double speed = (centre_velocity.col(b) - observer).norm();
    if (!(speed <= guard.speed)) {
      return {
          Outcome::speed,
          fmt::format("body {} moves at {:.3g} cm/s, over guard.speed = {:g} cm/s; try a smaller "
                      "time.step",
                      b, speed, guard.speed)};
    }
    if (scene.time.step * speed > farthest) {
      return {Outcome::speed,
              fmt::format("body {} moves {:.3g} cm in a step, over {} times "
                          "constraints.stride = {:g} cm; try a smaller time.step",
                          b, scene.time.step * speed, most_path_samples, scene.constraints.stride)};
    }
  }
  return {};
}

Status guard_state(const Model& model, const ObservedState& after, double crossing,
                   const Scene& scene, Watch& watch, std::vector<std::string>& warnings) {
  const GuardSettings& guard = scene.guard;
  const Observation& seen = after.observation;
  if (!seen.kin.centre.allFinite()) {
    return {Outcome::non_finite,
            "positions or velocities are not finite numbers; try a smaller time.step"};
  }
  Status status;
  const auto look = [&](Outcome outcome, const std::string& what, const std::string& remedy) {
    status = tell(outcome, guard.action, watch, warnings, what, "Do not use forces after this time",
                  remedy);
  };
  const char* finer = "try a smaller time.step or more constraints.corrections";
  if (seen.penetration > guard.penetration) {
    look(Outcome::penetration,
         fmt::format("{1} overlap by {0:.3g} cm, over guard.penetration = {2:g} cm",
                     seen.penetration, deepest_overlap(model, seen), guard.penetration),
         finer);
  } else if (crossing > guard.penetration) {
    look(Outcome::penetration,
         fmt::format("strands overlap by {:.3g} cm on the way to the next state, over "
                     "guard.penetration = {:g} cm",
                     crossing, guard.penetration),
         finer);
  }
  if (status.ok() && seen.limit_violation > guard.limit_violation) {
    look(Outcome::limits,
         fmt::format("{} is {:.3g} deg past its limit, over guard.limit_violation_deg = {:g}",
                     furthest_limit(model, after.state), seen.limit_violation / degree,
                     guard.limit_violation / degree),
         "try constraints.activation = \"speculative\" or a smaller time.step");
  }
  return status;
}

Status guard_energy(const StepInput& in, double passing, ObservedState& after, EnergyLedger& ledger,
                    Watch& watch, std::vector<std::string>& warnings) {
  const Model& model = in.model;
  const GuardSettings& guard = in.scene.guard;
  Kinematics& kin = after.observation.kin;
  const bool kept = keeps_momentum(in);
  double kinetic = kept ? inner_kinetic_energy(model, kin) : ledger.kinetic;
  const double passed = ledger.largest + ledger.dissipated;
  const double allowed = guard.energy_gain * passed;
  const double made = ledger.own_error() - ledger.lowest_error;
  ledger.lowest_error = std::min(ledger.lowest_error, ledger.own_error());
  Status status;
  const double rounding = passing_rounding * passing * passing / (2 * model.mass());
  if (!(made <= allowed + rounding)) {
    std::string what = fmt::format(
        "numerical errors added {:.3g} erg, over guard.energy_gain = {:g} times the body's energy "
        "and "
        "losses ({:.3g} erg)",
        made, guard.energy_gain, passed);
    if (guard.energy_action == EnergyAction::hold && in.scene.time.rule == TimeRule::euler) {
      const double taken = std::min(made - allowed, kinetic);
      const double share = kinetic > 0 ? std::sqrt(1 - taken / kinetic) : 0;
      Eigen::VectorXd& v = after.state.qdot;
      Eigen::Vector3d whole = Eigen::Vector3d::Zero();
      if (kept) whole = mean_by_mass(model, kin.centre_velocity);
      v.head<3>() -= whole;
      v *= share;
      v.head<3>() += whole;
      update_velocities(model, v, kin);
      kinetic -= taken;
      ledger.kinetic -= taken;
      ledger.integrator_held -= taken;
      what += "; velocities were reduced by the excess";
    }
    const bool stop = guard.energy_action == EnergyAction::stop;
    const GuardAction action = stop ? GuardAction::stop : GuardAction::warn;
    status = tell(Outcome::energy_gain, action, watch, warnings, what,
                  "Do not use speeds around this time; earlier speeds can be used",
                  "try a smaller time.step, or more drag or damping");
  }
  ledger.largest = std::max(ledger.largest, kinetic + ledger.elastic);
  return status;
}

void guard_momentum(const StepInput& in, double passing, const MomentumLedger& before,
                    const MomentumLedger& now, const EnergyLedger& energy, Watch& watch,
                    std::vector<std::string>& warnings) {
  if (in.control.clamp_head) {
    watch.made = {};
    return;
  }
  watch.made += now.integrator + now.given_back - before.integrator - before.given_back;
  // For a rigid motion |P|² <= 2 m T and |L|² <= 2 I T; a straight body has the largest I.
  const double largest = std::sqrt(2 * in.model.mass() * energy.largest);
  const double allowed = std::max(momentum_gain * largest, passing_rounding * passing);
  const double arm = in.model.length() / std::sqrt(12.0);
  if (std::max(watch.made.linear.norm(), watch.made.angular.norm() / arm) > allowed) {
    const bool kept = in.scene.time.momentum == FreeMomentum::kept;
    warn(
        Outcome::momentum_gain, watch, warnings,
        fmt::format("numerical errors pushed the free body by {:.3g} dyn s and turned it by {:.3g} "
                    "dyn cm s, over {:g} of the most that it can have",
                    watch.made.linear.norm(), watch.made.angular.norm(), momentum_gain),
        "The shape of the body can be used, but not its path through the water",
        kept ? "try a smaller time.step" : "try time.momentum = \"kept\" or a smaller time.step");
  }
}

void guard_cap(const Model& model, const Kinematics& kin, const Scene& scene, Phase phase,
               const StepSolution& step, double time, Watch& watch,
               std::vector<std::string>& warnings) {
  const auto at_cap = [&](const Row& row) {
    return phase != Phase::pull && row.kind == RowKind::thigmotaxis && row.upper > 0 &&
           step.lambda[&row - step.rows.data()] >= row.upper &&
           !meets_command(-step.excess[&row - step.rows.data()], row.rhs);
  };
  std::vector<CapWatch>& capped = watch.capped;
  std::erase_if(capped, [&](const CapWatch& one) {
    const auto row = std::ranges::find(step.rows, one.id, &Row::id);
    return row == step.rows.end() || !at_cap(*row);
  });
  for (const Row& row : step.rows) {
    if (!at_cap(row)) continue;
    const auto one = std::ranges::find(capped, row.id, &CapWatch::id);
    if (one == capped.end()) {
      capped.push_back({row.id, time});
      continue;
    }
    // The names take a factorisation, so they are found only once.
    if (time - one->since > scene.guard.capped_time && !watch.has_warned(Outcome::capped)) {
      const Eigen::Index i = &row - step.rows.data();
      const std::vector<const Row*> against = opponents(model, kin, step, i);
      std::string names;
      for (const Row* other : against) {
        names += (names.empty() ? "" : "; ") + row_name(model, *other);
      }
      warn(Outcome::capped, watch, warnings,
           fmt::format("{} has been at controller.cap = {:g} dyn for {:g} s and is still {:.3g} "
                       "cm/s too slow, held back most by {}",
                       row_name(model, row), scene.controller.cap, scene.guard.capped_time,
                       -step.excess[i], names.empty() ? "no row" : names),
           "Paths can be used, but not forces at the cap", cure_of_cap(row, against));
    }
  }
}

void guard_muscles(const Model& model, const Scene& scene, const Control& control, double time,
                   Watch& watch, std::vector<std::string>& warnings) {
  const Eigen::VectorXd& rest_shape = control.rest_shape;
  if (rest_shape.size() > 0 && !watch.has_warned(Outcome::overbent)) {
    const Eigen::Matrix2Xd ranges = hinge_ranges(model);
    const auto angles = rest_shape.tail(ranges.cols()).transpose();
    const Eigen::RowVectorXd past =
        (ranges.row(0) - angles).cwiseMax(angles - ranges.row(1)).cwiseMax(0.0);
    Eigen::Index k = 0;
    if (past.maxCoeff(&k) > scene.guard.limit_violation) {
      warn(Outcome::overbent, watch, warnings,
           fmt::format("the curvature program bends {} to {:.3g} deg at {:.2f} s, past its "
                       "limits of {:.3g} and {:.3g} deg",
                       dof_name(model, static_cast<int>(k) + root_dofs), angles[k] / degree,
                       time + scene.time.reach(), ranges(0, k) / degree, ranges(1, k) / degree),
           "The run can be used, except torques of muscles that work against a limit",
           "try a program within the limits or a larger model.limit_scale");
    }
  }
  const int saturated =
      control.active.saturated >= 0 ? control.active.saturated : control.torque.saturated;
  if (saturated >= 0 && !watch.has_warned(Outcome::saturated)) {
    warn(Outcome::saturated, watch, warnings,
         fmt::format("{} needs more torque than active.capacity = {:g} dyn cm at {:.2f} s",
                     dof_name(model, saturated), scene.active.capacity, time),
         "The run can be used, as one of an animal too weak for this movement",
         control.active.saturated >= 0
             ? "try a slower program, a softer body or more capacity"
             : "try a law that asks for less, or active.bounds_laws = false");
  }
}

}  // namespace hagfish
