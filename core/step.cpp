#include "core/step.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/dual_problem.hpp"

namespace hagfish {
namespace {

/// A row is left out at first where the unconstrained motion, or the last step's, keeps this much
/// clear of it, cm/s or rad/s. Only speed depends on it: rows left out are checked after the solve.
constexpr double lazy_reach = 2.0;
/// A row left out counts as violated below this, cm/s or rad/s: at h = 2 ms, 2e-11 cm or rad.
constexpr double lazy_tolerance = 1e-8;
/// λ, rows brought to unit diagonal, counts as a force above this share of the largest.
constexpr double active_share = 1e-6;

std::vector<Row> all_rows(const Model& model, const State& state, const Situation& situation,
                          const Control& control, const Scene& scene) {
  const double h = scene.time.step;
  std::vector<Row> rows;
  const auto append = [&rows](std::vector<Row> more) {
    rows.insert(rows.end(), more.begin(), more.end());
  };
  if (control.clamp_head) {
    append(head_rows(state, scene.constraints, h));
  }
  append(thigmotaxis_rows(model, control.thigmotaxis, scene.controller.cap, h));
  append(contact_rows(model, situation.contact, scene.constraints, h));
  append(limit_rows(model, state, scene.constraints, h));
  append(wall_rows(model, situation.kin, scene.wall, scene.constraints, h));
  return rows;
}

bool always_in(const Row& row) {
  return row.kind == RowKind::head || row.kind == RowKind::thigmotaxis;
}

/// Eqs. 7 and 8: f = C'λ / h, by kind of row.
ConstraintForces constraint_forces(const Model& model, const Kinematics& kin,
                                   const std::vector<Row>& rows, const Eigen::VectorXd& lambda,
                                   double h) {
  const auto of_kind = [&](RowKind kind) {
    Matrix6Xd wrench = Matrix6Xd::Zero(6, model.body_count());
    Eigen::VectorXd joint = Eigen::VectorXd::Zero(model.nv());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].kind == kind) {
        add_row(rows[i], kin, lambda[i] / h, wrench, joint);
      }
    }
    return (generalised_force(model, kin, wrench) + joint).eval();
  };
  return {of_kind(RowKind::head), of_kind(RowKind::limit), of_kind(RowKind::contact),
          of_kind(RowKind::wall), of_kind(RowKind::thigmotaxis)};
}

/// H⁻¹ (g + C'λ).
Eigen::VectorXd constrained_velocity(const Model& model, const Kinematics& kin,
                                     const ArticulatedFactor& factor, const StepSystem& system,
                                     const std::vector<Row>& rows, const Eigen::VectorXd& lambda) {
  Matrix6Xd wrench = system.wrench;
  Eigen::VectorXd joint = system.joint;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    add_row(rows[i], kin, lambda[i], wrench, joint);
  }
  return factor.solve(model, kin, wrench, joint);
}

/// Eq. 3 or Eq. 4 on the rows chosen, as one small problem in the multipliers.
Eigen::VectorXd solve_multipliers(const Model& model, const BoxQp& qp, const std::vector<Row>& rows,
                                  BoxQpSolver& solver, const WarmStart& warm, StepSolution& step) {
  const bool bilateral = std::all_of(rows.begin(), rows.end(),
                                     [](const Row& row) { return row.kind == RowKind::head; });
  BoxQpSolution solution;
  if (bilateral) {
    step.kind = SolveKind::kkt;
    solution = solve_bilateral(qp.A, qp.b);
  } else {
    step.kind = SolveKind::qp;
    Eigen::VectorXd start = Eigen::VectorXd::Zero(qp.b.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto it = warm.find(rows[i].id);
      start[i] = it == warm.end() ? 0 : it->second;
    }
    const auto begin = std::chrono::steady_clock::now();
    solution = solver.solve(qp, start);
    step.qp_time += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  step.iterations += solution.iterations;
  if (solution.status != SolveStatus::solved) {
    Eigen::Index worst = 0;
    (qp.b - qp.A * solution.x).cwiseQuotient(row_scale(qp.A)).maxCoeff(&worst);
    throw StepError(std::string("solver failed: ") + status_name(solution.status) + " on " +
                    std::to_string(qp.b.size()) +
                    " rows, furthest from being met: " + row_name(model, rows[worst]) +
                    (solution.message.empty() ? "" : " (" + solution.message + ")"));
  }
  return solution.x;
}

/// Eq. 1: H q̇* = M q̇0 + h f.
ArticulatedFactor unconstrained_motion(const Model& model, const State& state,
                                       const Kinematics& kin, const TipForce& tip, double h,
                                       StepSolution& step) {
  if (!state.q.allFinite() || !state.qdot.allFinite()) {
    throw StepError("non-finite state");
  }
  step.system = step_system(model, state, kin, tip, h);
  ArticulatedFactor factor;
  try {
    factor.factorise(model, kin, step.system.op);
  } catch (const std::domain_error& error) {
    throw StepError(error.what());
  }
  step.unconstrained = factor.solve(model, kin, step.system.wrench, step.system.joint);
  if (!step.unconstrained.allFinite()) {
    throw StepError("non-finite unconstrained velocity");
  }
  step.qdot = step.unconstrained;
  return factor;
}

/// Eq. 3 or 4 on step.rows; rows of `waiting` come in as the answer violates them.
BoxQp constrained_motion(const Model& model, const Kinematics& kin, const ArticulatedFactor& factor,
                         const DualProblem& dual, std::vector<Row> waiting, BoxQpSolver& solver,
                         const WarmStart& warm, StepSolution& step) {
  BoxQp qp;
  for (bool complete = step.rows.empty() && waiting.empty(); !complete;) {
    if (!step.rows.empty()) {
      qp = dual.assemble(step.rows);
      step.lambda = solve_multipliers(model, qp, step.rows, solver, warm, step);
      ++step.rounds;
      step.qdot = constrained_velocity(model, kin, factor, step.system, step.rows, step.lambda);
    }
    const Matrix6Xd twist = body_twists(model, kin, step.qdot);
    const auto violated =
        std::stable_partition(waiting.begin(), waiting.end(), [&](const Row& row) {
          return row_velocity(row, kin, twist, step.qdot) >= row.rhs - lazy_tolerance;
        });
    complete = violated == waiting.end();
    step.rows.insert(step.rows.end(), violated, waiting.end());
    waiting.erase(violated, waiting.end());
  }
  if (!step.qdot.allFinite()) {
    throw StepError("non-finite velocity");
  }
  return qp;
}

/// Forces and residuals on the primal side: q̇ against H, and the rows' excess C q̇ - d.
void measure(const Model& model, const Kinematics& kin, const BoxQp& qp, double h,
             StepSolution& step) {
  const auto m = static_cast<Eigen::Index>(step.rows.size());
  step.lambda.conservativeResize(m);
  step.excess.resize(m);
  const Matrix6Xd twist = body_twists(model, kin, step.qdot);
  for (Eigen::Index i = 0; i < m; ++i) {
    step.excess[i] = row_velocity(step.rows[i], kin, twist, step.qdot) - step.rows[i].rhs;
  }
  if (m > 0) {
    step.kkt = kkt_residuals(qp, step.lambda, step.excess);
  }
  step.force = constraint_forces(model, kin, step.rows, step.lambda, h);
  const Eigen::VectorXd impulse = h * step.force.total();
  const Eigen::VectorXd change =
      multiply(model, kin, step.system.op, step.qdot - step.unconstrained);
  // Over the largest momentum in the balance: forces may be nothing but rounding.
  const double scale = std::max(
      {impulse.lpNorm<Eigen::Infinity>(), change.lpNorm<Eigen::Infinity>(),
       multiply(model, kin, step.system.op, step.unconstrained).lpNorm<Eigen::Infinity>()});
  step.stationarity = scale == 0 ? 0 : (change - impulse).lpNorm<Eigen::Infinity>() / scale;
}

/// Counts the rows with a force and keeps their multipliers for the next step.
void keep_active(const BoxQp& qp, StepSolution& step, WarmStart& warm) {
  warm.clear();
  if (step.lambda.size() == 0) {
    return;
  }
  // Brought to one unit, rows of cm/s and rad/s compare.
  const Eigen::VectorXd size = step.lambda.cwiseAbs().cwiseProduct(row_scale(qp.A));
  for (Eigen::Index i = 0; i < step.lambda.size(); ++i) {
    if (size[i] > active_share * size.maxCoeff()) {
      ++step.active;
      warm[step.rows[i].id] = step.lambda[i];
    }
  }
}

}  // namespace

Situation observe(const Model& model, const State& state, const Scene& scene) {
  Situation s;
  s.kin = kinematics(model, state);
  s.segments = spline(model, s.kin.centre);
  s.contact = find_contacts(model, s.segments, scene.contact);
  s.penetration = std::max(0.0, -s.contact.least_gap);
  for (const Row& row : wall_rows(model, s.kin, scene.wall,
                                  {Activation::speculative, scene.constraints.push_out}, 1)) {
    const int body = row.force[0].body;
    s.penetration = std::max(s.penetration, model.bodies[body].radius - s.kin.centre(0, body));
  }
  for (int k = root_dofs; k < model.nv(); ++k) {
    const Hinge& hinge = model.hinges[k - root_dofs];
    s.limit_violation =
        std::max({s.limit_violation, hinge.lower - state.q[k + 1], state.q[k + 1] - hinge.upper});
  }
  return s;
}

double head_drift(const Model& model, const Kinematics& kin) {
  const Eigen::Vector3d origin = kin.origin.col(0);
  const Body& head = model.bodies[0];
  const Eigen::Matrix3d turn = kin.rotation[0] - Eigen::Matrix3d::Identity();
  return std::max({origin.norm(), (origin + head.length * turn.col(0)).norm(),
                   (origin + head.radius * turn.col(1)).norm()});
}

StepSolution solve_step(const Model& model, const State& state, const Situation& situation,
                        const Control& control, const Scene& scene, BoxQpSolver& solver,
                        WarmStart& warm) {
  const double h = scene.time.step;
  const Kinematics& kin = situation.kin;
  StepSolution step;
  const ArticulatedFactor factor = unconstrained_motion(model, state, kin, control.tip, h, step);

  const DualProblem dual(model, kin, factor, step.unconstrained);
  std::vector<Row> waiting;
  for (const Row& row : all_rows(model, state, situation, control, scene)) {
    const bool can_bind =
        always_in(row) || warm.contains(row.id) ||
        (!row.waits && (dual.excess_unconstrained(row) < lazy_reach ||
                        row_velocity(row, kin, kin.twist, state.qdot) - row.rhs < lazy_reach));
    (can_bind ? step.rows : waiting).push_back(row);
  }
  const BoxQp qp =
      constrained_motion(model, kin, factor, dual, std::move(waiting), solver, warm, step);

  measure(model, kin, qp, h, step);
  keep_active(qp, step, warm);
  const int last = model.body_count() - 1;
  const Vector6d twist = body_twists(model, kin, step.qdot).col(last);
  step.tip = control.tip.value - control.tip.rate * point_velocity(twist, kin.centre_offset(last));
  return step;
}

}  // namespace hagfish
