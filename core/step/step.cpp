#include "core/step/step.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace hagfish {
namespace {

/// A row is left out at first where rest and the last step's velocity keep this much clear of it,
/// cm/s or rad/s. Only speed depends on it: rows left out are checked after the solve.
constexpr double lazy_reach = 0.1;
/// A row left out counts as violated below this, cm/s or rad/s: at h = 2 ms, 2e-11 cm or rad.
constexpr double lazy_tolerance = 1e-8;
/// Pairs of segments that are no minimum of the gap are watched where they could close it in a step
/// at this speed, cm/s: next to a minimum, strands close slower than there.
constexpr double closing_speed = 1;
/// A limit's joint is held where its last multiplier would have to fall this much faster than it
/// last changed to vanish. Only speed depends on it: what had to pull is let go.
constexpr double steadiness = 2;
constexpr double nowhere = -std::numeric_limits<double>::infinity();

/// The unilateral rows that are near to binding. Pairs of segments that are no minimum of the gap
/// count only where they overlap or the wanted velocity makes them.
void append_unilateral_rows(const Model& model, const State& state, const Observation& observation,
                            const Scene& scene, const NearBinding& wanted, std::vector<Row>& rows) {
  const ConstraintSettings& settings = scene.constraints;
  const double h = scene.time.step;
  append_contact_rows(model, observation.contact.contacts, settings, h, wanted, rows);
  const NearBinding others{wanted.v, wanted.centre_velocity, std::min(wanted.slack, 0.0),
                           std::min(wanted.slack_at_rest, 0.0)};
  append_contact_rows(model, observation.contact.others, settings, h, others, rows);
  append_limit_rows(model, state, settings, h, wanted, rows);
  append_wall_rows(model, observation.kin, scene.wall, settings, h, wanted, rows);
}

/// Whether a row binds for all one can tell beforehand.
bool surely_binds(const Row& row, const WarmStart& warm) {
  if (row.kind == RowKind::head) {
    return true;
  }
  if (!row.unit()) {
    return false;
  }
  const WarmStart::Kept* kept = row.kind == RowKind::limit ? warm.find(row.id) : nullptr;
  return kept != nullptr && kept->lambda > steadiness * std::abs(kept->change);
}

/// Marks the rows whose velocities are held.
void hold_rows(const WarmStart& warm, std::vector<Row>& rows) {
  int last = -1;  // of a joint's two limits, which follow each other, one at most
  for (Row& row : rows) {
    row.held = surely_binds(row, warm) && row.dof != last;
    last = row.held ? row.dof : last;
  }
}

/// Lets go of the held rows that `goes` tells; whether there were any.
template <class Goes>
bool let_go(StepSolution& step, Goes goes) {
  bool any = false;
  for (Eigen::Index i = 0; i < step.held; ++i) {
    if (goes(i)) {
      step.rows[i].held = false;
      any = true;
    }
  }
  return any;
}

/// Names the rows that contradict each other; the active-set back end finds them where the one in
/// use does not. Without such rows, names the one furthest from being met.
[[noreturn]] void fail(const Model& model, const BoxQp& qp, const std::vector<Row>& rows,
                       const BoxQpSolution& solution) {
  std::vector<Eigen::Index> contradicting = solution.contradicting;
  if (contradicting.empty()) {
    const auto exact = make_box_qp_solver("active-set");
    contradicting = exact->solve(qp, Eigen::VectorXd::Zero(qp.b.size())).contradicting;
  }
  if (!contradicting.empty()) {
    std::string names;
    for (const Eigen::Index i : contradicting) {
      names += (names.empty() ? "" : "; ") + row_name(model, rows[i]);
    }
    throw StepError(StopCause::infeasible,
                    "rows contradict each other: " + names +
                        "; a start without overlap, a finite controller.cap or a smaller "
                        "time.step would help");
  }
  Eigen::Index worst = 0;
  (qp.b - qp.A * solution.x).cwiseQuotient(row_scale(qp.A)).maxCoeff(&worst);
  throw StepError(StopCause::solver_failed,
                  std::string("solver failed: ") + status_name(solution.status) + " on " +
                      std::to_string(qp.b.size()) +
                      " rows, furthest from being met: " + row_name(model, rows[worst]) +
                      (solution.message.empty() ? "" : " (" + solution.message + ")") +
                      "; another --qp or a smaller time.step would help");
}

/// Eq. 4 on the rows that are not held, as one small problem in the multipliers. False where those
/// contradict the held ones.
bool solve_multipliers(const Model& model, const BoxQp& qp, BoxQpSolver& solver,
                       StepScratch& scratch, StepSolution& step) {
  BoxQpSolution& solution = scratch.solution;
  step.kind = SolveKind::qp;
  const auto begin = std::chrono::steady_clock::now();
  solver.solve(qp, scratch.start, solution);
  step.qp_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  step.iterations += solution.iterations;
  if (solution.status == SolveStatus::solved) {
    step.lambda.tail(qp.b.size()) = solution.x;
    return true;
  }
  if (step.held == 0) {
    fail(model, qp, step.rows, solution);
  }
  return false;
}

/// q̇ = H⁻¹ (g + C'λ) with the λ of the rows that are not held; with it the bodies' twists and the λ
/// of those that are.
void set_velocity(const Model& model, const Kinematics& kin, StepScratch& scratch,
                  StepSolution& step) {
  scratch.wrench = step.system.wrench;
  scratch.joint = step.system.joint;
  for (auto i = static_cast<std::size_t>(step.held); i < step.rows.size(); ++i) {
    if (step.lambda[i] != 0) {
      add_row(step.rows[i], kin, step.lambda[i], scratch.wrench, scratch.joint);
    }
  }
  scratch.factor.solve(model, kin, scratch.wrench, scratch.joint, step.qdot, step.twist,
                       scratch.holding);
  centre_velocities(kin, step.twist, step.centre_velocity);
  for (Eigen::Index i = 0; i < step.held; ++i) {
    step.lambda[i] = step.rows[i].sign * scratch.holding[i];
  }
}

/// Eq. 1, H q̇* = M q̇0 + h f, or Eq. 3 with the rows that are held; they come first.
void base_motion(const Model& model, const Kinematics& kin, StepScratch& scratch,
                 StepSolution& step) {
  scratch.held.clear();
  for (Eigen::Index i = 0; i < step.held; ++i) {
    const Row& row = step.rows[i];
    scratch.held.push_back({row.dof, row.sign * row.rhs});
  }
  try {
    scratch.factor.factorise(model, kin, step.system.op, scratch.held);
  } catch (const std::domain_error& error) {
    throw StepError(StopCause::non_finite, error.what());
  }
  step.lambda.setZero(static_cast<Eigen::Index>(step.rows.size()));
  set_velocity(model, kin, scratch, step);
  if (!step.qdot.allFinite()) {
    throw StepError(StopCause::non_finite, "non-finite unconstrained velocity");
  }
  step.base = step.qdot;
  scratch.base_centre_velocity = step.centre_velocity;
}

/// Takes in rows that were left out and that q̇ violates; whether there were any.
bool take_in_violated(const Model& model, const State& state, const Observation& observation,
                      const Scene& scene, StepScratch& scratch, StepSolution& step) {
  scratch.violated.clear();
  append_unilateral_rows(model, state, observation, scene,
                         {step.qdot, step.centre_velocity, -lazy_tolerance, nowhere},
                         scratch.violated);
  bool any = false;
  for (const Row& row : scratch.violated) {
    if (std::ranges::find(step.rows, row.id, &Row::id) == step.rows.end()) {
      step.rows.push_back(row);
      any = true;
    }
  }
  return any;
}

/// Sorts the rows by their places, held ones first. With them the multipliers to start from.
void order_rows(const Model& model, const WarmStart& warm, StepScratch& scratch,
                StepSolution& step) {
  const std::size_t m = step.rows.size();
  // Rows of the round before, if there was one, come first and are still in their places.
  const std::size_t solved = step.rounds > 0 ? static_cast<std::size_t>(step.lambda.size()) : 0;
  scratch.order.clear();
  step.held = 0;
  for (std::size_t i = 0; i < m; ++i) {
    step.held += step.rows[i].held ? 1 : 0;
    scratch.order.emplace_back(place_in_step(model, step.rows[i]), i);
  }
  std::ranges::sort(scratch.order);
  scratch.ordered.clear();
  scratch.start.resize(static_cast<Eigen::Index>(m) - step.held);
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t i = scratch.order[k].second;
    scratch.ordered.push_back(step.rows[i]);
    const Eigen::Index place = static_cast<Eigen::Index>(k) - step.held;
    if (place >= 0) {
      scratch.start[place] = i < solved ? step.lambda[i] : warm.multiplier(step.rows[i].id);
    }
  }
  std::swap(step.rows, scratch.ordered);
}

/// Eq. 3 or 4 on step.rows; rows left out come in as the answer violates them, rows held are let go
/// as it pulls at them. `anew`: nothing is known yet of the motion with the rows held now.
void constrained_motion(const Model& model, const State& state, const Observation& observation,
                        const Scene& scene, BoxQpSolver& solver, const WarmStart& warm, bool anew,
                        StepScratch& scratch, StepSolution& step) {
  const Kinematics& kin = observation.kin;
  for (bool again = true; again;) {
    order_rows(model, warm, scratch, step);
    ++step.rounds;
    if (anew) {
      base_motion(model, kin, scratch, step);
    }
    const auto others = std::span(step.rows).subspan(static_cast<std::size_t>(step.held));
    if (!others.empty()) {
      step.lambda.conservativeResize(static_cast<Eigen::Index>(step.rows.size()));
      step.lambda.tail(scratch.start.size()) = scratch.start;
      assemble_dual(model, kin, scratch.factor, others, step.base, scratch.base_centre_velocity,
                    scratch.columns, scratch.qp);
      if (!solve_multipliers(model, scratch.qp, solver, scratch, step)) {
        anew = let_go(step, [](Eigen::Index) { return true; });
        continue;
      }
      set_velocity(model, kin, scratch, step);
    }
    anew = let_go(step, [&](Eigen::Index i) { return step.lambda[i] < step.rows[i].lower; });
    again = take_in_violated(model, state, observation, scene, scratch, step) || anew;
  }
  if (!step.qdot.allFinite()) {
    throw StepError(StopCause::non_finite, "non-finite velocity");
  }
}

}  // namespace

void observe(const Model& model, const State& state, const Scene& scene, ContactSearch& search,
             Observation& observation) {
  Observation& s = observation;
  update_positions(model, state.q, s.kin);
  update_velocities(model, state.qdot, s.kin);
  update_spline(model, s.kin.centre, s.segments);
  find_contacts(s.segments, scene.contact, closing_speed * scene.time.step, search, s.contact);
  s.penetration = std::max(0.0, -s.contact.least_gap);
  visit_wall_gaps(model, s.kin, scene.wall,
                  [&](int, double gap) { s.penetration = std::max(s.penetration, -gap); });
  s.limit_violation = 0;
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    s.limit_violation =
        std::max({s.limit_violation, hinge.lower - state.q[k + 1], state.q[k + 1] - hinge.upper});
  }
  for (const BendingCone& cone : model.cones) {
    s.limit_violation = std::max(s.limit_violation, past_cone(cone, state.q));
  }
}

Observation observe(const Model& model, const State& state, const Scene& scene) {
  ContactSearch search;
  Observation observation;
  observe(model, state, scene, search, observation);
  return observation;
}

double head_drift(const Model& model, const Kinematics& kin) {
  const Eigen::Vector3d origin = kin.origin.col(0);
  const Body& head = model.bodies[0];
  const Eigen::Matrix3d turn = kin.rotation[0] - Eigen::Matrix3d::Identity();
  return std::max({origin.norm(), (origin + head.length * turn.col(0)).norm(),
                   (origin + head.radius * turn.col(1)).norm()});
}

void gather_rows(const Model& model, const State& state, const Observation& observation,
                 const Control& control, const Scene& scene, std::vector<Row>& rows) {
  const double h = scene.time.step;
  rows.clear();
  if (control.clamp_head) {
    append_head_rows(state, scene.constraints, h, rows);
  }
  append_thigmotaxis_rows(model, control.thigmotaxis, scene.controller,
                          observation.kin.centre_velocity, h, rows);
  append_unilateral_rows(model, state, observation, scene,
                         {state.qdot, observation.kin.centre_velocity, lazy_reach, lazy_reach},
                         rows);
}

void begin_step(const Model& model, const State& state, const Observation& observation,
                const Control& control, const Scene& scene, BoxQpSolver& solver,
                const WarmStart& warm, StepScratch& scratch, StepSolution& step) {
  if (!state.q.allFinite() || !state.qdot.allFinite()) {
    throw StepError(StopCause::non_finite, "non-finite state");
  }
  const Kinematics& kin = observation.kin;
  assemble_step_system(model, state, kin, control.tip, scene.time.step, step.system);
  gather_rows(model, state, observation, control, scene, step.rows);
  hold_rows(warm, step.rows);
  step.kind = SolveKind::linear;
  step.iterations = 0;
  step.rounds = 0;
  step.qp_time = 0;
  step.held = 0;
  bool anew = true;
  if (step.rows.empty()) {
    base_motion(model, kin, scratch, step);
    if (!take_in_violated(model, state, observation, scene, scratch, step)) {
      return;
    }
    anew = false;
  }
  step.kind = SolveKind::kkt;
  constrained_motion(model, state, observation, scene, solver, warm, anew, scratch, step);
}

void resume_step(const Model& model, const State& state, const Observation& observation,
                 const Scene& scene, BoxQpSolver& solver, const WarmStart& warm,
                 StepScratch& scratch, StepSolution& step) {
  constrained_motion(model, state, observation, scene, solver, warm, false, scratch, step);
}

void solve_step(const Model& model, const State& state, const Observation& observation,
                const Control& control, const Scene& scene, BoxQpSolver& solver, WarmStart& warm,
                StepScratch& scratch, StepSolution& step) {
  begin_step(model, state, observation, control, scene, solver, warm, scratch, step);
  finish_step(model, observation, control, scene, warm, scratch, step);
}

}  // namespace hagfish
