#include "core/step.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
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
constexpr double nowhere = -std::numeric_limits<double>::infinity();
/// λ, rows brought to unit diagonal, counts as a force above this share of the largest.
constexpr double active_share = 1e-6;

/// The unilateral rows that are near to binding. Pairs of segments that are no minimum of the gap
/// count only where they overlap or the wanted velocity makes them.
void append_unilateral_rows(const Model& model, const State& state, const Situation& situation,
                            const Scene& scene, const NearBinding& wanted, std::vector<Row>& rows) {
  const ConstraintSettings& settings = scene.constraints;
  const double h = scene.time.step;
  append_contact_rows(model, situation.contact.contacts, settings, h, wanted, rows);
  const NearBinding others{wanted.v, wanted.centre_velocity, std::min(wanted.slack, 0.0),
                           std::min(wanted.slack_at_rest, 0.0)};
  append_contact_rows(model, situation.contact.others, settings, h, others, rows);
  append_limit_rows(model, state, settings, h, wanted, rows);
  append_wall_rows(model, situation.kin, scene.wall, settings, h, wanted, rows);
}

/// Eqs. 7 and 8: f = C'λ / h, by kind of row.
void sum_forces(const Model& model, const Kinematics& kin, double h, StepScratch& scratch,
                StepSolution& step) {
  const auto of_kind = [&](RowKind kind, Eigen::VectorXd& force) {
    scratch.wrench.setZero(6, model.body_count());
    scratch.joint.setZero(model.nv());
    bool any = false;
    for (std::size_t i = 0; i < step.rows.size(); ++i) {
      if (step.rows[i].kind == kind && step.lambda[i] != 0) {
        add_row(step.rows[i], kin, step.lambda[i] / h, scratch.wrench, scratch.joint);
        any = true;
      }
    }
    if (any) {
      generalised_force(model, kin, scratch.wrench, force);
      force += scratch.joint;
    } else {
      force.setZero(model.nv());
    }
  };
  of_kind(RowKind::head, step.force.head);
  of_kind(RowKind::limit, step.force.limit);
  of_kind(RowKind::contact, step.force.contact);
  of_kind(RowKind::wall, step.force.wall);
  of_kind(RowKind::thigmotaxis, step.force.thigmotaxis);
}

/// q̇ = H⁻¹ (g + C'λ), and the bodies' twists.
void set_velocity(const Model& model, const Kinematics& kin, StepScratch& scratch,
                  StepSolution& step) {
  scratch.wrench = step.system.wrench;
  scratch.joint = step.system.joint;
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    if (step.lambda[i] != 0) {
      add_row(step.rows[i], kin, step.lambda[i], scratch.wrench, scratch.joint);
    }
  }
  scratch.factor.solve(model, kin, scratch.wrench, scratch.joint, step.qdot, step.twist);
  centre_velocities(kin, step.twist, step.centre_velocity);
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

/// Eq. 3 or Eq. 4 on the rows chosen, as one small problem in the multipliers.
void solve_multipliers(const Model& model, const BoxQp& qp, BoxQpSolver& solver,
                       StepScratch& scratch, StepSolution& step) {
  const std::vector<Row>& rows = step.rows;
  const bool bilateral = std::all_of(rows.begin(), rows.end(),
                                     [](const Row& row) { return row.kind == RowKind::head; });
  BoxQpSolution& solution = scratch.solution;
  if (bilateral) {
    step.kind = SolveKind::kkt;
    solution = solve_bilateral(qp.A, qp.b);
  } else {
    step.kind = SolveKind::qp;
    const auto begin = std::chrono::steady_clock::now();
    solver.solve(qp, scratch.start, solution);
    step.qp_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  step.iterations += solution.iterations;
  if (solution.status != SolveStatus::solved) {
    fail(model, qp, rows, solution);
  }
  step.lambda = solution.x;
}

/// Eq. 1: H q̇* = M q̇0 + h f.
void unconstrained_motion(const Model& model, const State& state, const Kinematics& kin,
                          const TipForce& tip, double h, StepScratch& scratch, StepSolution& step) {
  if (!state.q.allFinite() || !state.qdot.allFinite()) {
    throw StepError(StopCause::non_finite, "non-finite state");
  }
  assemble_step_system(model, state, kin, tip, h, step.system);
  try {
    scratch.factor.factorise(model, kin, step.system.op);
  } catch (const std::domain_error& error) {
    throw StepError(StopCause::non_finite, error.what());
  }
  scratch.factor.solve(model, kin, step.system.wrench, step.system.joint, step.unconstrained,
                       scratch.unconstrained_twist);
  if (!step.unconstrained.allFinite()) {
    throw StepError(StopCause::non_finite, "non-finite unconstrained velocity");
  }
  centre_velocities(kin, scratch.unconstrained_twist, scratch.unconstrained_centre_velocity);
  step.qdot = step.unconstrained;
  step.twist = scratch.unconstrained_twist;
  step.centre_velocity = scratch.unconstrained_centre_velocity;
}

/// Takes in rows that were left out and that q̇ violates; whether there were any.
bool take_in_violated(const Model& model, const State& state, const Situation& situation,
                      const Scene& scene, StepScratch& scratch, StepSolution& step) {
  scratch.violated.clear();
  append_unilateral_rows(model, state, situation, scene,
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

/// Sorts the rows by where along the body they end, the last first, which is what the columns of
/// the dual problem like best; but bilateral ones before all others. With them the multipliers to
/// start from.
void order_rows(const Model& model, const WarmStart& warm, StepScratch& scratch,
                StepSolution& step) {
  const std::size_t m = step.rows.size();
  // Rows of the round before, if there was one, come first and are still in their places.
  const std::size_t solved = step.rounds > 0 ? static_cast<std::size_t>(step.lambda.size()) : 0;
  scratch.order.clear();
  for (std::size_t i = 0; i < m; ++i) {
    const Row& row = step.rows[i];
    const bool bilateral = row.kind == RowKind::head;
    scratch.order.emplace_back(bilateral ? -model.nv() - 1 : -leading_dofs(model, row), i);
  }
  std::ranges::sort(scratch.order);
  scratch.ordered.clear();
  scratch.start.resize(static_cast<Eigen::Index>(m));
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t i = scratch.order[k].second;
    scratch.ordered.push_back(step.rows[i]);
    const double* kept = i < solved ? &step.lambda[i] : warm.find(step.rows[i].id);
    scratch.start[k] = kept == nullptr ? 0 : *kept;
  }
  std::swap(step.rows, scratch.ordered);
}

/// Eq. 3 or 4 on step.rows; rows left out come in as the answer violates them.
void constrained_motion(const Model& model, const State& state, const Situation& situation,
                        const Scene& scene, BoxQpSolver& solver, const WarmStart& warm,
                        StepScratch& scratch, StepSolution& step) {
  const Kinematics& kin = situation.kin;
  do {
    order_rows(model, warm, scratch, step);
    assemble_dual(model, kin, scratch.factor, step.rows, step.unconstrained,
                  scratch.unconstrained_centre_velocity, scratch.columns, scratch.qp);
    solve_multipliers(model, scratch.qp, solver, scratch, step);
    ++step.rounds;
    set_velocity(model, kin, scratch, step);
  } while (take_in_violated(model, state, situation, scene, scratch, step));
  if (!step.qdot.allFinite()) {
    throw StepError(StopCause::non_finite, "non-finite velocity");
  }
}

/// Forces and residuals on the primal side: q̇ against H, and the rows' excess C q̇ - d.
void measure(const Model& model, const Kinematics& kin, double h, StepScratch& scratch,
             StepSolution& step) {
  const auto m = static_cast<Eigen::Index>(step.rows.size());
  step.lambda.conservativeResize(m);
  step.excess.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    step.excess[i] = row_velocity(step.rows[i], step.centre_velocity, step.qdot) - step.rows[i].rhs;
  }
  step.kkt = m > 0 ? kkt_residuals(scratch.qp, step.lambda, step.excess) : KktResiduals{};
  sum_forces(model, kin, h, scratch, step);
  scratch.impulse = h * step.force.head;
  scratch.impulse += h * step.force.limit;
  scratch.impulse += h * step.force.contact;
  scratch.impulse += h * step.force.wall;
  scratch.impulse += h * step.force.thigmotaxis;
  scratch.joint = step.qdot - step.unconstrained;
  multiply(model, kin, step.system.op, scratch.joint, scratch.wrench, scratch.change);
  generalised_force(model, kin, step.system.wrench, scratch.joint);
  scratch.joint += step.system.joint;  // H q̇*
  // Over the largest momentum in the balance: forces may be nothing but rounding.
  const double scale =
      std::max({scratch.impulse.lpNorm<Eigen::Infinity>(), scratch.change.lpNorm<Eigen::Infinity>(),
                scratch.joint.lpNorm<Eigen::Infinity>()});
  scratch.change -= scratch.impulse;
  step.stationarity = scale == 0 ? 0 : scratch.change.lpNorm<Eigen::Infinity>() / scale;
}

/// Counts the rows with a force and keeps their multipliers for the next step.
void keep_active(StepScratch& scratch, StepSolution& step, WarmStart& warm) {
  warm.clear();
  step.active = 0;
  if (step.lambda.size() == 0) {
    return;
  }
  // Brought to one unit, rows of cm/s and rad/s compare.
  scratch.scale.resize(step.lambda.size());
  row_scale(scratch.qp.A, scratch.scale);
  scratch.scale.array() *= step.lambda.array().abs();
  const double least = active_share * scratch.scale.maxCoeff();
  for (Eigen::Index i = 0; i < step.lambda.size(); ++i) {
    if (scratch.scale[i] > least) {
      ++step.active;
      warm.add(step.rows[i].id, step.lambda[i]);
    }
  }
  warm.sort();
}

}  // namespace

void WarmStart::sort() { std::sort(entries_.begin(), entries_.end()); }

const double* WarmStart::find(std::int64_t id) const {
  const auto it =
      std::lower_bound(entries_.begin(), entries_.end(), id,
                       [](const auto& entry, std::int64_t wanted) { return entry.first < wanted; });
  return it == entries_.end() || it->first != id ? nullptr : &it->second;
}

void observe(const Model& model, const State& state, const Scene& scene, ContactSearch& search,
             Situation& situation) {
  Situation& s = situation;
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
}

Situation observe(const Model& model, const State& state, const Scene& scene) {
  ContactSearch search;
  Situation situation;
  observe(model, state, scene, search, situation);
  return situation;
}

double head_drift(const Model& model, const Kinematics& kin) {
  const Eigen::Vector3d origin = kin.origin.col(0);
  const Body& head = model.bodies[0];
  const Eigen::Matrix3d turn = kin.rotation[0] - Eigen::Matrix3d::Identity();
  return std::max({origin.norm(), (origin + head.length * turn.col(0)).norm(),
                   (origin + head.radius * turn.col(1)).norm()});
}

void gather_rows(const Model& model, const State& state, const Situation& situation,
                 const Control& control, const Scene& scene, std::vector<Row>& rows) {
  const double h = scene.time.step;
  rows.clear();
  if (control.clamp_head) {
    append_head_rows(state, scene.constraints, h, rows);
  }
  append_thigmotaxis_rows(model, control.thigmotaxis, scene.controller.cap, h, rows);
  append_unilateral_rows(model, state, situation, scene,
                         {state.qdot, situation.kin.centre_velocity, lazy_reach, lazy_reach}, rows);
}

void begin_step(const Model& model, const State& state, const Situation& situation,
                const Control& control, const Scene& scene, BoxQpSolver& solver,
                const WarmStart& warm, StepScratch& scratch, StepSolution& step) {
  step.kind = SolveKind::linear;
  step.iterations = 0;
  step.rounds = 0;
  step.qp_time = 0;
  unconstrained_motion(model, state, situation.kin, control.tip, scene.time.step, scratch, step);
  gather_rows(model, state, situation, control, scene, step.rows);
  if (!step.rows.empty() || take_in_violated(model, state, situation, scene, scratch, step)) {
    constrained_motion(model, state, situation, scene, solver, warm, scratch, step);
  }
}

void resume_step(const Model& model, const State& state, const Situation& situation,
                 const Scene& scene, BoxQpSolver& solver, const WarmStart& warm,
                 StepScratch& scratch, StepSolution& step) {
  constrained_motion(model, state, situation, scene, solver, warm, scratch, step);
}

void finish_step(const Model& model, const Situation& situation, const Control& control,
                 const Scene& scene, WarmStart& warm, StepScratch& scratch, StepSolution& step) {
  measure(model, situation.kin, scene.time.step, scratch, step);
  keep_active(scratch, step, warm);
  const int last = model.body_count() - 1;
  step.tip = control.tip.value - control.tip.rate * step.centre_velocity.col(last);
}

void solve_step(const Model& model, const State& state, const Situation& situation,
                const Control& control, const Scene& scene, BoxQpSolver& solver, WarmStart& warm,
                StepScratch& scratch, StepSolution& step) {
  begin_step(model, state, situation, control, scene, solver, warm, scratch, step);
  finish_step(model, situation, control, scene, warm, scratch, step);
}

}  // namespace hagfish
