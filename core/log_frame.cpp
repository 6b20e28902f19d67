#include "core/log_frame.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hagfish {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
// Relative to the commanded speed, or to 1 cm/s where that is less: Ipopt's tolerance moves the
// speed of a row by 1e-8 of the largest in the step.
constexpr double slack_tolerance = 1e-6;

std::vector<std::string> phase_names() {
  std::vector<std::string> names;
  for (int k = 0; k < phase_count; ++k) {
    names.emplace_back(phase_name(static_cast<Phase>(k)));
  }
  return names;
}

const std::vector<std::string>& solve_names() {
  static const std::vector<std::string> names = {"linear", "kkt", "qp"};
  return names;
}

double worst_residual(const StepSolution& s) { return std::max(s.kkt.worst(), s.stationarity); }

/// Bodies of the thigmotaxis contacts, [first, last].
std::array<int, 2> bodies(const Frame& frame, int (Contact::*body)() const) {
  std::array<int, 2> pair{-1, -1};
  for (std::size_t k = 0; k < frame.record.control.thigmotaxis.size(); ++k) {
    pair[k] = (frame.record.control.thigmotaxis[k].contact.*body)();
  }
  return pair;
}

void declare_trajectory(const Model& model, LogTable<Frame>& t) {
  const hsize_t n = model.body_count();
  const hsize_t nq = model.nq();
  const hsize_t nv = model.nv();
  const std::string rates = "cm/s, rad/s";
  t.index("/trajectory/step", "index of the step that begins at the frame",
          [](const Frame& f) { return f.record.step; });
  t.number("/trajectory/time", {"s", "simulated time"},
           [](const Frame& f) { return f.record.time; });
  t.choice("/trajectory/phase", phase_names(), "phase of the experiment",
           [](const Frame& f) { return f.record.controller.phase; });
  t.numbers(
      "/trajectory/q", {nq},
      {"mixed: cm, 1, rad", "root position, root quaternion wxyz, hinge angles (MuJoCo qpos)"},
      [](const Frame& f) -> const auto& { return f.record.state.q; });
  t.numbers(
      "/trajectory/qdot", {nv},
      {rates, "root velocity (world), root rate (body axes), hinge rates (MuJoCo qvel)"},
      [](const Frame& f) -> const auto& { return f.record.state.qdot; });
  t.numbers(
      "/trajectory/qdot_next", {nv},
      {rates, "velocity after the step that begins at the frame, to which its forces lead"},
      [](const Frame& f) -> const auto& { return f.record.solution.qdot; });
  t.numbers(
      "/trajectory/position", {n, 3}, {"cm", "body centres, world axes"},
      [](const Frame& f) -> const auto& { return f.record.situation.kin.centre; });
}

void declare_knot(LogTable<Frame>& t) {
  t.count("/knot/determinant", "knot determinant: 1 unknot, 3 3_1, 5 4_1 or 5_1, 7 5_2",
          [](const Frame& f) { return f.knot.type.determinant; });
  t.count("/knot/v2", "Vassiliev invariant of order 2: 0 unknot, 1 3_1, -1 4_1, 3 5_1, 2 5_2",
          [](const Frame& f) { return f.knot.type.v2; });
  t.number("/knot/agreement", {"1", "share of the projections that agree"},
           [](const Frame& f) { return f.knot.agreement; });
  t.number("/knot/head_end", {"cm", "arc length from the head of the first contact"},
           [](const Frame& f) {
             const auto span = knot_span(f.record.controller);
             return span ? span->head_end : nan;
           });
  t.number("/knot/tail_end", {"cm", "arc length from the head of the last contact"},
           [](const Frame& f) {
             const auto span = knot_span(f.record.controller);
             return span ? span->tail_end : nan;
           });
}

void declare_forces(const Model& model, LogTable<Frame>& t) {
  const hsize_t nv = model.nv();
  const auto force = [&](const char* name, const char* description,
                         Eigen::VectorXd ConstraintForces::*member) {
    t.numbers(
        std::string("/forces/") + name, {nv},
        {"dyn, dyn·cm", description, true}, [member](const Frame& f) -> const auto& {
          return f.record.solution.force.*member;
        });
  };
  force("thigmotaxis", "C_thigmo' lambda_thigmo / h (Eq. 8)", &ConstraintForces::thigmotaxis);
  force("contact", "self-contact", &ConstraintForces::contact);
  force("limit", "joint limits", &ConstraintForces::limit);
  force("head", "head clamp", &ConstraintForces::head);
  force("wall", "head plate", &ConstraintForces::wall);
  t.numbers(
      "/forces/tip", {3}, {"dyn", "scripted force on the last body, world axes"},
      [](const Frame& f) -> const auto& { return f.record.solution.tip; });
}

void declare_thigmotaxis(LogTable<Frame>& t) {
  t.pair("/thigmotaxis/body_a", "strand nearer the head at [first, last] contact; -1 where none",
         [](const Frame& f) { return bodies(f, &Contact::body_a); });
  t.pair("/thigmotaxis/body_b", "strand nearer the tail at [first, last] contact; -1 where none",
         [](const Frame& f) { return bodies(f, &Contact::body_b); });
  const std::string order = "first t_a, first t_b, last t_a, last t_b: ";
  t.numbers(
      "/thigmotaxis/lambda", {4}, {"dyn", order + "multiplier over h, 0 where no row"},
      [](const Frame& f) -> const auto& { return f.thigmotaxis.lambda; });
  t.numbers(
      "/thigmotaxis/speed", {4}, {"cm/s", order + "left side of Eq. 6, nan where no row"},
      [](const Frame& f) -> const auto& { return f.thigmotaxis.speed; });
  t.numbers(
      "/thigmotaxis/slack", {4},
      {"cm/s", order + "shortfall of the speed asked for, nan where no row"},
      [](const Frame& f) -> const auto& { return f.thigmotaxis.slack; });
}

void declare_diagnostics(LogTable<Frame>& t) {
  const std::string path = "/diagnostics/";
  t.choice(path + "solve", solve_names(), "least that the step had to solve",
           [](const Frame& f) { return f.record.solution.kind; });
  t.count(path + "rows", "rows in the problem",
          [](const Frame& f) { return f.record.solution.rows.size(); });
  t.count(path + "active", "rows with a force",
          [](const Frame& f) { return f.record.solution.active; });
  t.count(path + "contacts", "local minima of the gap within the margin",
          [](const Frame& f) { return f.record.situation.contact.contacts.size(); });
  t.count(path + "iterations", "iterations of the QP back end",
          [](const Frame& f) { return f.record.solution.iterations; });
  t.number(
      path + "kkt_stationarity",
      {"1", "|H (qdot_next - qdot*) - h sum of forces|, infinity norm over the largest momentum"},
      [](const Frame& f) { return f.record.solution.stationarity; });
  t.number(path + "kkt_primal", {"1", "row violation, scaled, infinity norm"},
           [](const Frame& f) { return f.record.solution.kkt.primal; });
  t.number(path + "kkt_complementarity", {"1", "multiplier times excess, scaled, infinity norm"},
           [](const Frame& f) { return f.record.solution.kkt.complementarity; });
  t.number(path + "kkt_worst", {"1", "largest of the three at any step since the last frame"},
           [](const Frame& f) { return f.worst.kkt; });
  t.number(path + "penetration", {"cm", "deepest at any step since the last frame"},
           [](const Frame& f) { return f.worst.penetration; });
  t.number(path + "limit_violation", {"rad", "largest at any step since the last frame"},
           [](const Frame& f) { return f.worst.limit_violation; });
  t.number(path + "head_drift", {"cm", "largest since the last frame while clamped"},
           [](const Frame& f) { return f.worst.head_drift; });
  t.number(path + "qp_time", {"s", "wall time in the QP back end"},
           [](const Frame& f) { return f.record.solution.qp_time; });
  t.number(path + "wall_time", {"s", "elapsed since the run began"},
           [](const Frame& f) { return f.wall_time; });
}

void declare_energy(LogTable<Frame>& t) {
  const auto energy = [&t](const char* name, const char* description,
                           double EnergyLedger::*member) {
    t.number(std::string("/diagnostics/") + name, {"erg", description},
             [member](const Frame& f) { return f.record.ledger.*member; });
  };
  energy("kinetic_energy", "kinetic energy", &EnergyLedger::kinetic);
  energy("elastic_energy", "energy in the joint springs", &EnergyLedger::elastic);
  energy("gravity_energy", "potential energy, 0 at the world's origin", &EnergyLedger::gravity);
  energy("work_tip", "work of the scripted force so far", &EnergyLedger::work_tip);
  energy("work_thigmotaxis", "work of f_thigmo so far", &EnergyLedger::work_thigmotaxis);
  energy("work_contact", "work of self-contact so far", &EnergyLedger::work_contact);
  energy("work_limit", "work of the joint limits so far", &EnergyLedger::work_limit);
  energy("work_head", "work of the head clamp so far", &EnergyLedger::work_head);
  energy("work_wall", "work of the head plate so far", &EnergyLedger::work_wall);
  energy("dissipated", "lost to drag and joint damping so far", &EnergyLedger::dissipated);
  energy("integrator_inertia",
         "gained by the integrator from velocity changes, impacts included, so far",
         &EnergyLedger::integrator_inertia);
  energy("integrator_potential", "gained by the integrator from springs and gravity so far",
         &EnergyLedger::integrator_potential);
  energy("integrator_coriolis", "gained by the integrator from explicit Coriolis forces so far",
         &EnergyLedger::integrator_coriolis);
  energy("integrator_held",
         "taken back from the velocity so far: what the integrator gained too much",
         &EnergyLedger::integrator_held);
  t.number("/diagnostics/integrator_error", {"erg", "sum of the integrator's terms"},
           [](const Frame& f) { return f.record.ledger.integrator_error(); });
}

}  // namespace

ThigmotaxisRows thigmotaxis_rows_of(const StepSolution& solution, double h) {
  ThigmotaxisRows rows;
  rows.speed.fill(nan);
  rows.slack.fill(nan);
  std::size_t next = 0;
  rows.met = true;
  for (std::size_t i = 0; i < solution.rows.size(); ++i) {
    const Row& row = solution.rows[i];
    if (row.kind != RowKind::thigmotaxis) {
      continue;
    }
    const auto index = static_cast<Eigen::Index>(i);
    rows.lambda[next] = solution.lambda[index] / h;
    rows.speed[next] = solution.excess[index] + row.rhs;
    rows.slack[next] = std::max(0.0, -solution.excess[index]);
    rows.met = rows.met && rows.slack[next] <= slack_tolerance * std::max(1.0, std::abs(row.rhs));
    ++next;
  }
  rows.any = next > 0;
  rows.met = rows.met && rows.any;
  return rows;
}

void Worst::take(const StepRecord& record) {
  penetration = std::max(penetration, record.situation.penetration);
  limit_violation = std::max(limit_violation, record.situation.limit_violation);
  head_drift = std::max(head_drift, record.head_drift);
  kkt = std::max(kkt, worst_residual(record.solution));
}

void declare_frames(const Model& model, Hdf5Writer& file, LogTable<Frame>& table) {
  for (const char* group : {"/trajectory", "/knot", "/forces", "/thigmotaxis", "/diagnostics"}) {
    file.group(group);
  }
  declare_trajectory(model, table);
  declare_knot(table);
  declare_forces(model, table);
  declare_thigmotaxis(table);
  declare_diagnostics(table);
  declare_energy(table);
}

void declare_steps(Hdf5Writer& file, LogTable<StepRecord>& t, double h) {
  file.group("/steps");
  t.choice("/steps/solve", solve_names(), "least that each step had to solve",
           [](const StepRecord& r) { return r.solution.kind; });
  t.count("/steps/rows", "rows in the problem of each step",
          [](const StepRecord& r) { return r.solution.rows.size(); });
  t.count("/steps/iterations", "back end iterations of each step",
          [](const StepRecord& r) { return r.solution.iterations; });
  t.count("/steps/eq6", "Eq. 6 as asked at each step: -1 no rows, 0 with slack, 1 met",
          [h](const StepRecord& r) {
            const ThigmotaxisRows rows = thigmotaxis_rows_of(r.solution, h);
            return rows.any ? static_cast<int>(rows.met) : -1;
          });
  t.number("/steps/kkt", {"1", "largest KKT residual of each step"},
           [](const StepRecord& r) { return worst_residual(r.solution); });
  t.number("/steps/penetration", {"cm", "deepest at each step's start"},
           [](const StepRecord& r) { return r.situation.penetration; });
  t.number("/steps/limit_violation", {"rad", "largest at each step's start"},
           [](const StepRecord& r) { return r.situation.limit_violation; });
  t.number("/steps/head_drift", {"cm", "at each step's start while clamped"},
           [](const StepRecord& r) { return r.head_drift; });
  t.number("/steps/qp_time", {"s", "wall time in the QP back end, each step"},
           [](const StepRecord& r) { return r.solution.qp_time; });
}

}  // namespace hagfish
