#include "core/step/midpoint/midpoint_rule.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

/// Least share of a pass's change that is taken to remain.
constexpr double least_remaining = 1e-3;

/// How far velocities differ (nv both): the largest of the hinges' rates, rad/s, and of the root's
/// velocity as a whole, cm/s, and turn. So it is the same however the world's axes lie.
double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::VectorXd off = a - b;
  return std::max(off.head<3>().norm(), off.tail(off.size() - 3).lpNorm<Eigen::Infinity>());
}

/// Keeps the multipliers of a pass for the next one.
void keep_pass(const StepSolution& step, WarmStart& warm) {
  warm.begin();
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    if (const double kept = step.multipliers[static_cast<Eigen::Index>(i)]; kept != 0) {
      warm.add(step.rows[i].id, kept);
    }
  }
  warm.end();
}

}  // namespace

StepPlace MidpointRule::place(const StepInput& /*in*/) const {
  return {midway_.kin, midway_.motion(), midway_.step_velocity, &midway_.segments};
}

Status MidpointRule::begin(const StepInput& in, Rounds& rounds, WarmStart& warm,
                           StepSolution& step) {
  guess_middle(in, warm);
  return settle(in, rounds, warm, step);
}

/// The velocity that places the middle at first: extrapolated from its changes in the last two
/// steps.
void MidpointRule::guess_middle(const StepInput& in, const WarmStart& warm) {
  const Eigen::Index nv = in.model.nv();
  first_guess_.resize(2 * nv);
  first_guess_.head(nv) = in.state.qdot;
  if (warm.half_before.size() > 0) first_guess_.head(nv) += 2 * warm.half_change - warm.half_before;
  if (warm.half_change.size() == 0 && !in.control.clamp_head) {
    first_guess_.head<3>() += in.scene.time.reach() * in.model.gravity;
  }
  first_guess_.tail(nv) = first_guess_.head(nv);
}

/// Passes from first_guess_ on, and the remedies if they do not converge.
Status MidpointRule::settle(const StepInput& in, Rounds& rounds, WarmStart& warm,
                            StepSolution& step) {
  // A balanced bias may keep the passes from converging; without it they may converge.
  Status status = find_middle(in, true, rounds, warm, step);
  const auto settled_or_stopped = [&] {
    return status.ok() ? step.middle.unsettled == 0 : status.outcome == Outcome::stopped;
  };
  if (!settled_or_stopped()) status = find_middle(in, false, rounds, warm, step);
  if (settled_or_stopped()) return status;
  // Passes that do not converge may diverge until one fails. Then the step is taken from its own
  // first velocity.
  if (!status.ok()) step.middle.unsettled = INFINITY;
  midway_.step_velocity = midway_.mean_velocity = in.state.qdot;
  place_midway(in.model, in.state, in.observation.kin, in.scene.time.step, false,
               keeps_momentum(in), midway_);
  step.middle.remaining = 1;
  return solve_here(in, rounds, warm, step);
}

/// Passes that place the step's middle until it converges. If it does not, step.middle.unsettled
/// says so.
Status MidpointRule::find_middle(const StepInput& in, bool balanced, Rounds& rounds,
                                 WarmStart& warm, StepSolution& step) {
  const TimeSettings& time = in.scene.time;
  const Eigen::Index nv = in.model.nv();
  StepMiddle& middle = step.middle;
  midway_.step_velocity = first_guess_.head(nv);
  midway_.mean_velocity = first_guess_.tail(nv);
  middle.passes = balanced ? 0 : time.passes;
  middle.unsettled = 0;
  middle.remaining = guessed_remaining(warm.remaining);
  double before = 0;  // change in the last pass
  passes_.restart();
  placed_by_.resize(2 * nv);
  led_to_.resize(2 * nv);
  for (int pass = 1;; ++pass) {
    ++middle.passes;
    place_midway(in.model, in.state, in.observation.kin, time.step, balanced, keeps_momentum(in),
                 midway_);
    if (Status status = solve_here(in, rounds, warm, step); !status.ok()) return status;
    const double off = difference(step.qdot, midway_.step_velocity);
    if (pass > 1) {
      // Changes shrink by the factor θ: the rest is off (θ + θ² + ...) = off θ / (1 - θ).
      middle.remaining = off < before ? std::max(off / (before - off), least_remaining) : INFINITY;
    }
    if (off == 0 || middle.remaining * off <= time.settled) return {};
    before = off;
    if (pass >= time.passes) {
      middle.unsettled = off;
      return {};
    }
    keep_pass(step, warm);
    placed_by_ << midway_.step_velocity, midway_.mean_velocity;
    led_to_ << step.qdot, 0.5 * (in.state.qdot + step.next);
    passes_.mix(placed_by_, led_to_, mixed_);
    midway_.step_velocity = mixed_.head(nv);
    midway_.mean_velocity = mixed_.tail(nv);
  }
}

/// Solves the step at midway_, and finds the velocity after it.
Status MidpointRule::solve_here(const StepInput& in, Rounds& rounds, const WarmStart& warm,
                                StepSolution& step) {
  Status status = rounds.begin(in, place(in), warm, step);
  return status.ok() ? set_next_velocity(in, place(in), rounds.problem(), step, half_change_)
                     : status;
}

Status MidpointRule::resume(const StepInput& in, Rounds& rounds, WarmStart& warm,
                            StepSolution& step) {
  Status status = rounds.resume(in, place(in), warm, step);
  if (status.ok()) status = set_next_velocity(in, place(in), rounds.problem(), step, half_change_);
  if (!status.ok() || difference(step.qdot, midway_.step_velocity) <= in.scene.time.settled) {
    return status;
  }
  keep_pass(step, warm);
  first_guess_ << step.qdot, 0.5 * (in.state.qdot + step.next);
  return settle(in, rounds, warm, step);
}

void MidpointRule::end(const StepInput& in, WarmStart& warm, StepSolution& step) {
  step.mean_velocity = 0.5 * (in.state.qdot + step.next);
  body_twists(in.model, midway_.kin, step.mean_velocity, step.mean_twist);
  centre_velocities(midway_.kin, step.mean_twist, step.mean_centre_velocity);
  warm.half_before = warm.half_change;
  warm.half_change = half_change_;
  warm.remaining = step.middle.remaining;
  step.lambda.resize(step.multipliers.size());
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    step.lambda[i] = 2 * step.multipliers[i] - step.rows[i].impact;
  }
  step.middle.step_velocity = midway_.step_velocity;
  step.middle.mean_velocity = midway_.mean_velocity;
  step.middle.off = (step.qdot - midway_.step_velocity).norm();
}

}  // namespace hagfish
