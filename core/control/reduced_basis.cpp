#include "core/control/reduced_basis.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/control/laws.hpp"
#include "core/scene/interpolation.hpp"

namespace hagfish {
namespace {

constexpr Eigen::Index before_amplitudes = 3;  ///< numbers of the memory

/// For all shapes, the part about the axis of `hinge` at `x`: cm of arc, or a share of the window.
void set_shapes(const ReducedBasisSettings& basis, const Hinge& hinge, double sign, double x,
                Eigen::MatrixXd::RowXpr shapes) {
  const int axis = shape_row(hinge.axis);
  if (basis.cosines > 0) {
    for (int j = 0; j < basis.cosines; ++j) {
      shapes[axis * basis.cosines + j] = sign * std::cos(std::numbers::pi * j * x);
    }
    return;
  }
  if (x < basis.stations.front() || x > basis.stations.back()) return;
  const std::size_t count = basis.stations.size();
  const Bracket place = bracket_of(basis.stations, x);
  const std::vector<double>& values =
      axis == 0 ? basis.bend_y : (axis == 1 ? basis.bend_z : basis.twist);
  for (Eigen::Index j = 0; j < shapes.size(); ++j) {
    const std::size_t first = static_cast<std::size_t>(j) * count;
    shapes[j] = sign * value_at(place, [&](std::size_t k) { return values[first + k]; });
  }
}

/// The torque towards the rest shape, as a mean over `steps` steps to come in which the hinges move
/// evenly and tone follows them. The passive spring is compensated, so its work over the one long
/// step is taken back.
void mean_tone_torque(const Situation& at, double steps, const Eigen::VectorXd& rest,
                      ActiveTorque& torque) {
  const Model& model = at.model;
  const double h = at.scene.time.step;
  const double kept = std::exp(-h / at.scene.active.tone_time);
  const double left = (1 - std::pow(kept, steps)) / (steps * (1 - kept));
  const double lag = h + h * kept / (1 - kept) * (1 - left);
  torque.value.setZero(model.nv());
  torque.rate.setZero(model.nv());
  for (int d = root_dofs; d < model.nv(); ++d) {
    const Hinge& hinge = model.hinges[d - root_dofs];
    const double active = at.scene.active.stiffness / hinge_span(model, hinge.body);
    const double all = active + hinge.stiffness;
    const double angle = at.now.state.q[d + 1];
    torque.value[d] = all * left * (rest[d] - angle) + hinge.stiffness * angle;
    torque.rate[d] = all * lag - hinge.stiffness * steps * h;
  }
}

/// The paper's step of `scene` from `at`, `steps` of the run's steps long. The rows with a force in
/// it are held below.
void look_forward(const Situation& at, const Scene& scene, double steps, const Control& control,
                  UntakenStep& ahead) {
  ahead.control.clamp_head = control.clamp_head;
  ahead.control.tip = control.tip;
  ahead.control.thigmotaxis = control.thigmotaxis;
  if (control.rest_shape.size() > 0) {
    mean_tone_torque(at, steps, control.rest_shape, ahead.control.active);
  } else {
    ahead.control.active = {};
  }
  ahead.begin(at, scene);
}

/// Eq. 6 after a step as a function of a: gain a >= shortfall.
struct Eq6 {
  Eigen::MatrixXd gain;       ///< cm/s of each row for a unit of each a
  Eigen::VectorXd shortfall;  ///< shortfall of each row at a = 0, cm/s
};

/// Eq. 6 after the step `ahead` of length `h` (s), with the velocities of the rows that have a
/// force in it fixed.
Eq6 eq6_after(const Situation& at, double h, const Eigen::MatrixXd& shapes,
              const UntakenStep& ahead) {
  const StepSolution& step = ahead.step;
  const RowProblem& problem = ahead.solver.problem();
  const auto row_of = [&](Eigen::Index i) -> const Row& { return step.rows[step.prescribed + i]; };
  std::vector<Eigen::Index> bearing, asked;  // rows with a force, rows of Eq. 6
  for (Eigen::Index i = 0; i < problem.qp.b.size(); ++i) {
    if (row_of(i).kind == RowKind::thigmotaxis) {
      asked.push_back(i);
    } else if (step.multipliers[step.prescribed + i] != 0) {
      bearing.push_back(i);
    }
  }
  // The force of the held rows for a unit row of Eq. 6.
  Eigen::MatrixXd share = problem.qp.A(bearing, asked);
  if (!bearing.empty()) {
    Eigen::LDLT<Eigen::MatrixXd>(problem.qp.A(bearing, bearing)).solveInPlace(share);
  }
  std::vector<PrescribedVelocity> still = problem.prescribed;
  for (PrescribedVelocity& velocity : still) velocity.value = 0;
  const Kinematics& kin = at.now.observation.kin;
  const auto count = static_cast<Eigen::Index>(asked.size());
  Eq6 eq6{Eigen::MatrixXd(count, shapes.cols()), problem.qp.b(asked)};
  Matrix6Xd wrench, twist;
  Eigen::VectorXd joint, velocity, reaction;
  for (Eigen::Index t = 0; t < count; ++t) {
    // H⁻¹ is symmetric: the response of the hinges to the row is the response of the row to the
    // hinges.
    wrench.setZero(6, at.model.body_count());
    joint.setZero(at.model.nv());
    add_row(row_of(asked[t]), kin, 1, wrench, joint);
    for (Eigen::Index c = 0; c < share.rows(); ++c) {
      add_row(row_of(bearing[c]), kin, -share(c, t), wrench, joint);
      eq6.shortfall[t] -= share(c, t) * problem.qp.b[bearing[c]];
    }
    problem.factor.solve(at.model, kin, wrench, joint, still, velocity, twist, reaction);
    eq6.gain.row(t).noalias() = h * velocity.transpose() * shapes;
  }
  return eq6;
}

/// The smallest |a| that meets `eq6`, softly, within the bound on the torques. The dual is a box QP
/// with one multiplier for each row of Eq. 6.
Eigen::VectorXd find_least(const ReducedBasisSettings& basis, const Eq6& eq6,
                           const Eigen::MatrixXd& shapes) {
  const Eigen::Index count = eq6.shortfall.size();
  BoxQp qp{eq6.gain * eq6.gain.transpose(), eq6.shortfall, Eigen::VectorXd::Zero(count),
           Eigen::VectorXd::Constant(count, INFINITY)};
  qp.A.diagonal().array() += basis.softness * qp.A.diagonal().maxCoeff();
  const BoxQpSolution solution = make_box_qp_solver("active-set")->solve(qp, qp.lower);
  if (solution.status != SolveStatus::solved) {
    throw StepError(
        {Outcome::solver_failed, "the QP for the numbers of the reduced basis failed: " +
                                     std::string(status_name(solution.status))});
  }
  Eigen::VectorXd a = eq6.gain.transpose() * solution.x;
  const double largest = (shapes * a).lpNorm<Eigen::Infinity>();
  if (largest > basis.most) a *= basis.most / largest;
  return a;
}

/// The played a at the knot's place.
void play(const ReducedBasisSettings& basis, double head_end, Eigen::VectorXd& a) {
  const Bracket place = bracket_of(basis.places, head_end);
  const auto size = static_cast<std::size_t>(a.size());
  for (std::size_t j = 0; j < size; ++j) {
    a[static_cast<Eigen::Index>(j)] =
        value_at(place, [&](std::size_t k) { return basis.played[size * k + j]; });
  }
}

void begin(const ReducedBasisSettings& basis, double time, const KnotSpan& window,
           ReducedBasisMemory& memory) {
  memory.next = time;
  memory.window = window;
  memory.aim.setZero(basis_size(basis));
  memory.now.setZero(basis_size(basis));
}

/// The share of its difference that a first-order filter covers in a step.
double follows(double h, double time_constant) {
  return time_constant > 0 ? 1 - std::exp(-h / time_constant) : 1;
}

std::optional<SceneFault> fault(const Specimen& /*specimen*/, const Scene& scene) {
  const ReducedBasisSettings& basis = scene.controller.reduced_basis;
  const std::string where = " where controller.law = \"reduced_basis\"";
  const auto at = [](const char* key, const std::string& why,
                     std::optional<std::size_t> element = {}) {
    return SceneFault{std::string("controller.reduced_basis.") + key, why, element};
  };
  if ((basis.cosines > 0) != basis.stations.empty()) {
    return at("cosines", "must be positive, or file must be given, but not both," + where);
  }
  if (basis.most == 0) return at("most", "must be positive" + where);
  if (basis.places.empty()) {
    if (basis.period == 0) return at("period", "must be positive" + where);
    if (basis.softness == 0) return at("softness", "must be positive" + where);
    if (!basis.played.empty()) return at("played", "needs places");
    return {};
  }
  for (std::size_t i = 1; i < basis.places.size(); ++i) {
    if (basis.places[i] <= basis.places[i - 1]) return at("places", "must rise", i);
  }
  const std::size_t size = basis.places.size() * static_cast<std::size_t>(basis_size(basis));
  if (basis.places.size() < 2 || basis.played.size() != size) {
    return at("played", "must have places x shapes values, " + std::to_string(size) +
                            ", of two places or more");
  }
  return {};
}

constexpr LawNumbers numbers[] = {
    {.path = "/basis/amplitude",
     .unit = "dyn·cm",
     .description = "a of u = B a, torques in place of Eq. 6; nan but in the slide",
     .size = [](const Model& /*model*/, const Scene& scene) -> Eigen::Index {
       return basis_size(scene.controller.reduced_basis);
     },
     .of = [](const Eigen::VectorXd& memory,
              Eigen::Index size) { return Eigen::VectorXd(memory.tail(size)); }},
    {.path = "/basis/window",
     .unit = "cm",
     .description = "first and last contact of the knot, smoothed, between which with a margin the "
                    "shapes lie that travel with it; nan but in the slide",
     .size = [](const Model& /*model*/, const Scene& /*scene*/) -> Eigen::Index { return 2; },
     .of = [](const Eigen::VectorXd& memory,
              Eigen::Index size) { return Eigen::VectorXd(memory.segment(1, size)); }}};

}  // namespace

void basis_shapes(const Model& model, const Scene& scene, const KnotSpan& window,
                  Eigen::MatrixXd& shapes) {
  const ReducedBasisSettings& basis = scene.controller.reduced_basis;
  shapes.setZero(model.nv(), basis_size(basis));
  const double length = model.length();
  const bool knot = basis.frame == BasisFrame::knot;
  const double from = knot ? window.head_end - basis.margin : 0;
  const double to = knot ? window.tail_end + basis.margin : length;
  for (int k = 0; k < model.hinge_count(); ++k) {
    const Hinge& hinge = model.hinges[k];
    const double arc = length * hinge.body / model.body_count();
    if (arc < from || arc > to) continue;
    const bool share = knot || basis.cosines > 0;
    set_shapes(basis, hinge, scene.mirror && hinge.axis != Axis::y ? -1 : 1,
               share ? (arc - from) / (to - from) : arc, shapes.row(root_dofs + k));
  }
}

void unpack(const Eigen::VectorXd& memory, ReducedBasisMemory& unpacked) {
  const Eigen::Index size = (memory.size() - before_amplitudes) / 2;
  unpacked.next = memory[0];
  unpacked.window = {memory[1], memory[2]};
  unpacked.aim = memory.segment(before_amplitudes, size);
  unpacked.now = memory.tail(size);
}

void reduced_basis_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                       ReducedBasisStorage& storage) {
  all_contacts_law(at, control);
  if (at.so_far.phase != Phase::slide || control.thigmotaxis.empty()) {
    memory.resize(0);
    return;
  }
  const ReducedBasisSettings& basis = at.scene.controller.reduced_basis;
  const double h = at.scene.time.step;
  const KnotSpan span = *knot_span(at.so_far);
  ReducedBasisMemory& m = storage.memory;
  if (memory.size() == 0) {
    begin(basis, at.time, span, m);
  } else {
    unpack(memory, m);
  }
  const double share = follows(h, basis.smooth);
  m.window.head_end += share * (span.head_end - m.window.head_end);
  m.window.tail_end += share * (span.tail_end - m.window.tail_end);
  basis_shapes(at.model, at.scene, m.window, storage.shapes);
  if (!basis.places.empty()) {
    play(basis, m.window.head_end, m.aim);
  } else if (at.time + 0.5 * h >= m.next) {
    const double steps = std::max(1.0, std::round(basis.period / h));
    m.next += steps * h;
    Scene scene = at.scene;
    scene.time.step = steps * h;
    scene.time.rule = TimeRule::euler;
    look_forward(at, scene, steps, control, storage.ahead);
    m.aim = find_least(basis, eq6_after(at, scene.time.step, storage.shapes, storage.ahead),
                       storage.shapes);
  }
  m.now += follows(h, basis.filter) * (m.aim - m.now);
  control.torque.value.noalias() = storage.shapes * m.now;
  control.torque.rate.setZero(at.model.nv());
  for (ThigmotaxisCommand& command : control.thigmotaxis) command.effort = 0;
  memory.resize(before_amplitudes + 2 * m.now.size());
  memory << m.next, m.window.head_end, m.window.tail_end, m.aim, m.now;
}

extern constinit const Law reduced_basis_record{
    .name = "reduced_basis",
    .description = "a few numbers times fixed shapes of torque slide the knot",
    .make = law_with_storage<ReducedBasisStorage, reduced_basis_law>,
    .memory_size = [](const Model& /*model*/, const Scene& scene) -> Eigen::Index {
      return before_amplitudes + 2 * basis_size(scene.controller.reduced_basis);
    },
    .fault = fault,
    .numbers = numbers,
    .table = "reduced_basis"};

}  // namespace hagfish
