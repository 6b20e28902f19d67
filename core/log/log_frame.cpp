#include "core/log/log_frame.hpp"

#include <algorithm>
#include <cmath>

#include "core/control/laws.hpp"
#include "core/log/ledger_columns.hpp"
#include "core/log/means/log_means.hpp"

namespace hagfish {
namespace {

constexpr std::array phases = names_by_value(phase_table);

// Frames are some 50 a second of simulated time; a chunk is read and written as one.
constexpr hsize_t frame_chunk_rows = 64;
// Of logs below LogLevel::full, all of which is compressed.
constexpr hsize_t packed_frames = 256;

const LabelledAxis space{3, axis_labels};
const LabelledAxis on_plate{2, plate_labels};
const LabelledAxis both_contacts{2, contact_labels};
const LabelledAxis strands{4, strand_labels};

LabelledAxis dofs_of(const Model& model) { return {static_cast<hsize_t>(model.nv()), dof_labels}; }

/// Bodies of the thigmotaxis contacts, [first, last].
std::array<int, 2> bodies(const Frame& frame, int (Contact::*body)() const) {
  std::array<int, 2> pair{-1, -1};
  for (const ThigmotaxisCommand& command : frame.record.control.thigmotaxis) {
    if (command.end != KnotEnd::neither) {
      pair[static_cast<std::size_t>(command.end)] = (command.contact.*body)();
    }
  }
  return pair;
}

PullFigures pull_figures_of(const Frame& frame) {
  const bool pulls = frame.mean.pulls && frame.record.controller.phase == Phase::pull;
  return pulls ? pull_figures(frame.mean) : PullFigures{};
}

/// Spline parameters of the contacts that the controller follows, [first, last].
std::array<double, 2> followed(const Frame& frame, int Contact::*segment, double Contact::*t) {
  std::array<double, 2> pair{NAN, NAN};
  const TouchingEnds& ends = frame.record.controller.ends;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::optional<Contact>& contact = k == 0 ? ends.first : ends.last;
    if (contact) pair[k] = *contact.*segment + *contact.*t;
  }
  return pair;
}

constexpr const char* active_description = "active torque of the animal's muscles, 0 at the root";

void declare_trajectory(const Model& model, LogTable<Frame>& t) {
  const LabelledAxis n{static_cast<hsize_t>(model.body_count()), body_labels};
  const LabelledAxis joints{static_cast<hsize_t>(model.body_count()), joint_labels};
  const LabelledAxis nq{static_cast<hsize_t>(model.nq()), coordinate_labels};
  const LabelledAxis nv = dofs_of(model);
  const std::string rates = "cm/s, rad/s";
  t.index("/trajectory/step", "index of the step that begins at the frame",
          [](const Frame& f) { return f.record.step; });
  t.number("/trajectory/time", {"s", "simulated time"},
           [](const Frame& f) { return f.record.time; });
  t.choice("/trajectory/phase", {phases.begin(), phases.end()}, "phase of the experiment",
           [](const Frame& f) { return f.record.controller.phase; });
  t.numbers(
      "/trajectory/q", {nq},
      {"mixed: cm, 1, rad", "root position, root quaternion wxyz, hinge angles (MuJoCo qpos)"},
      [](const Frame& f) -> const auto& { return f.record.after.state.q; });
  t.numbers(
      "/trajectory/qdot", {nv},
      {rates, "root velocity (world), root rate (body axes), hinge rates (MuJoCo qvel)"},
      [](const Frame& f) -> const auto& { return f.record.after.state.qdot; });
  t.numbers(
      "/trajectory/qdot_next", {nv},
      {rates, "velocity after the step that begins at the frame, to which its forces lead"},
      [](const Frame& f) -> const auto& { return f.record.solution.next; });
  t.numbers(
      "/trajectory/q_ref", {nv},
      {"rad",
       "rest shape of the step that begins at the frame: angles that the active torque pulls the "
       "hinges to; 0 at the root and where no curvature program bends the animal",
       Storage::packed},
      [none = Eigen::VectorXd(Eigen::VectorXd::Zero(model.nv()))](const Frame& f) -> const auto& {
        const Eigen::VectorXd& rest = f.record.controller.rest_shape;
        return rest.size() == 0 ? none : rest;
      });
  t.numbers(
      "/trajectory/position", {n, space}, {"cm", "body centres, world axes"},
      [](const Frame& f) -> const auto& { return f.record.after.observation.kin.centre; });
  t.numbers(
      "/trajectory/curvature", {joints, space},
      {"1/cm",
       "turn of each joint as a vector in axes halfway through it, over the body it stands for"},
      [model](const Frame& f) { return joint_curvature(model, f.record.after.observation.kin); });
}

/// /midway: what the midpoint rule's equations are of.
void declare_midway(const Model& model, LogTable<Frame>& t) {
  const LabelledAxis nv = dofs_of(model);
  const auto velocity = [&](const char* name, const char* description, auto get) {
    t.numbers(std::string("/midway/") + name, {nv}, {"cm/s, rad/s", description}, get);
  };
  velocity(
      "moved",
      "velocity that takes half a step from the frame to the middle of its step, where its "
      "equations hold",
      [](const Frame& f) -> const auto& { return f.record.solution.middle.step_velocity; });
  velocity(
      "felt", "velocity that the bodies' inertia is taken to have there",
      [](const Frame& f) -> const auto& { return f.record.solution.middle.mean_velocity; });
  velocity(
      "qdot",
      "velocity by which the step moves, which meets the rows: impulses act on it in full, "
      "steady forces by half; springs, damping and drag act at the mean of qdot and qdot_next",
      [](const Frame& f) -> const auto& { return f.record.solution.qdot; });
}

void declare_knot(LogTable<Frame>& t) {
  t.count("/knot/determinant", "knot determinant: 1 unknot, 3 3_1, 5 4_1 or 5_1, 7 5_2",
          [](const Frame& f) { return f.knot.type.determinant; });
  t.count("/knot/v2", "Vassiliev invariant of order 2: 0 unknot, 1 3_1, -1 4_1, 3 5_1, 2 5_2",
          [](const Frame& f) { return f.knot.type.v2; });
  t.number("/knot/agreement", {"1", "share of the projections that agree"},
           [](const Frame& f) { return f.knot.agreement; });
  t.number("/knot/head_end",
           {"cm",
            "arc length from the head of the knot's head end: the first contact, in the mean over "
            "its patch"},
           [](const Frame& f) {
             const auto span = knot_span(f.record.controller);
             return span ? span->head_end : NAN;
           });
  t.number("/knot/tail_end",
           {"cm",
            "arc length from the head of the knot's tail end: the last contact, in the mean over "
            "its patch"},
           [](const Frame& f) {
             const auto span = knot_span(f.record.controller);
             return span ? span->tail_end : NAN;
           });
}

void declare_forces(const Model& model, LogTable<Frame>& t) {
  const LabelledAxis nv = dofs_of(model);
  for (const RowKindEntry& force : row_kind_table) {
    t.numbers(
        std::string("/forces/") + force.name, {nv},
        {"dyn, dyn·cm", force.description, Storage::blocks},
        [kind = force.value](const Frame& f) -> const auto& {
          return f.record.solution.force[kind];
        });
  }
  t.numbers(
      "/forces/active", {nv}, {"dyn, dyn·cm", active_description, Storage::blocks},
      [](const Frame& f) -> const auto& { return f.record.solution.active_torque; });
  t.numbers(
      "/forces/tip", {space}, {"dyn", "scripted force on the last body, world axes"},
      [](const Frame& f) -> const auto& { return f.record.solution.tip; });
}

void declare_thigmotaxis(LogTable<Frame>& t) {
  t.pair("/thigmotaxis/body_a", "strand nearer the head at [first, last] contact; -1 where none",
         [](const Frame& f) { return bodies(f, &Contact::body_a); });
  t.pair("/thigmotaxis/body_b", "strand nearer the tail at [first, last] contact; -1 where none",
         [](const Frame& f) { return bodies(f, &Contact::body_b); });
  const std::string parameter =
      " of the [first, last] contact followed, segment + t in bodies from the head; nan where none";
  t.numbers("/thigmotaxis/spline_a", {both_contacts},
            {"1", "spline parameter on the strand a" + parameter},
            [](const Frame& f) { return followed(f, &Contact::segment_a, &Contact::t_a); });
  t.numbers("/thigmotaxis/spline_b", {both_contacts},
            {"1", "spline parameter on the strand b" + parameter},
            [](const Frame& f) { return followed(f, &Contact::segment_b, &Contact::t_b); });
  const auto row = [&t](const char* name, const char* unit, const std::string& description,
                        std::array<double, 4> ThigmotaxisRows::*member) {
    t.numbers(
        std::string("/thigmotaxis/") + name, {strands},
        {unit, strand_order + description}, [member](const Frame& f) -> const auto& {
          return f.thigmotaxis.*member;
        });
  };
  row("command", "cm/s", "right side of Eq. 6, nan where no row", &ThigmotaxisRows::command);
  row("lambda", "dyn", "multiplier over h, 0 where no row", &ThigmotaxisRows::lambda);
  row("speed", "cm/s", "left side of Eq. 6, nan where no row", &ThigmotaxisRows::speed);
  row("slack", "cm/s", "shortfall of the command, nan where no row", &ThigmotaxisRows::slack);
  t.number("/thigmotaxis/cap", {"dyn", "largest multiplier over h of a row; nan where no row"},
           [](const Frame& f) { return f.thigmotaxis.cap; });
}

/// /control: what a run's own law asks for, as far as nothing else says it.
void declare_control(const Model& model, LogTable<Frame>& t) {
  t.count("/control/clamp_head", "whether the head is clamped: 1, or 0",
          [](const Frame& f) { return f.record.control.clamp_head ? 1 : 0; });
  t.numbers(
      "/control/tip", {space}, {"dyn", "force on the last body asked for, at rest, world axes"},
      [](const Frame& f) -> const auto& { return f.record.control.tip.value; });
  t.number("/control/tip_rate", {"dyn s/cm", "what the force loses by the last body's velocity"},
           [](const Frame& f) { return f.record.control.tip.rate; });
  t.count("/control/has_rest_shape", "whether muscles pull to /trajectory/q_ref: 1, or 0",
          [](const Frame& f) { return f.record.control.rest_shape.size() > 0 ? 1 : 0; });
  const auto torque = [&](const char* name, const char* unit, const char* description,
                          Eigen::VectorXd ActiveTorque::*member) {
    t.numbers(
        std::string("/control/") + name, {dofs_of(model)}, {unit, description, Storage::packed}, [
          member, none = Eigen::VectorXd(Eigen::VectorXd::Zero(model.nv()))
        ](const Frame& f) -> const auto& {
          const Eigen::VectorXd& values = f.record.control.torque.*member;
          return values.size() == 0 ? none : values;
        });
  };
  torque("torque", "dyn·cm",
         "torques of the hinges asked for, at rest, besides those towards the rest shape",
         &ActiveTorque::value);
  torque("torque_rate", "dyn·cm·s", "what they lose by the hinges' rates", &ActiveTorque::rate);
}

/// Numbers of the law's memory.
void declare_memory(const Model& model, const Scene& scene, LogTable<Frame>& t) {
  for (const LawNumbers& numbers : law_of(scene).numbers) {
    const bool of_muscles = numbers.size == nullptr;
    const Eigen::Index size = of_muscles ? model.muscle_count() : numbers.size(model, scene);
    if (size == 0) continue;
    t.numbers(numbers.path, {{static_cast<hsize_t>(size), of_muscles ? muscle_labels : ""}},
              {numbers.unit, numbers.description}, [size, of = numbers.of](const Frame& f) {
                const Eigen::VectorXd& memory = f.record.controller.memory;
                return memory.size() == 0 ? Eigen::VectorXd::Constant(size, NAN) : of(memory, size);
              });
  }
}

/// /mean: what stands in the snapshots' groups, as means.
void declare_means(const Model& model, LogTable<Frame>& t) {
  const std::string since = ", mean over the steps since the frame before; nan at the first frame";
  for (const RowKindEntry& force : row_kind_table) {
    t.numbers(
        std::string("/mean/forces/") + force.name, {dofs_of(model)},
        {"dyn, dyn·cm", force.description + since, Storage::blocks},
        [kind = force.value](const Frame& f) -> const auto& { return f.mean.force[kind]; });
  }
  t.numbers(
      "/mean/forces/active", {dofs_of(model)},
      {"dyn, dyn·cm", active_description + since, Storage::blocks},
      [](const Frame& f) -> const auto& { return f.mean.active_torque; });
  t.numbers(
      "/mean/forces/net", {dofs_of(model)},
      {"dyn, dyn·cm", "H (qdot_next - qdot*) / h, what they add up to, from the motion" + since},
      [](const Frame& f) -> const auto& { return f.mean.net_force; });
  const LabelledAxis joints{static_cast<hsize_t>(model.body_count()), joint_labels};
  const auto moment = [&](const std::string& name, const std::string& description, auto of) {
    t.numbers("/mean/moments/" + name, {joints, space},
              {"dyn·cm",
               "moment about each joint, in axes halfway through it, of " + description + since},
              of);
  };
  for (const RowKindEntry& force : row_kind_table) {
    if (force.value == RowKind::head) continue;  // it is on the head alone
    moment(
        force.name, force.description + std::string(" on the bodies behind it"),
        [kind = force.value](const Frame& f) -> const auto& { return f.moments.of_rows[kind]; });
  }
  moment(
      "active", "the muscles' torques",
      [](const Frame& f) -> const auto& { return f.moments.active; });
  const auto row = [&](const char* name, const char* unit, const std::string& description,
                       std::array<double, 4> FrameMeans::*member) {
    t.numbers(
        std::string("/mean/thigmotaxis/") + name, {strands},
        {unit, strand_order + description + since}, [member](const Frame& f) -> const auto& {
          return f.mean.*member;
        });
  };
  row("lambda", "dyn", "multiplier over h, 0 where no row", &FrameMeans::lambda);
  row("speed", "cm/s", "left side of Eq. 6 where there was a row, else nan", &FrameMeans::speed);
  row("slack", "cm/s", "shortfall of the command where there was a row, else nan",
      &FrameMeans::slack);
  t.number(
      "/mean/thigmotaxis/sum",
      {"dyn", "sum of the multipliers over h of all rows of Eq. 6, at other contacts, too" + since},
      [](const Frame& f) { return f.mean.sum_of_rows; });
}

/// /muscle: what muscles have to do for the torques.
void declare_muscles(const Model& model, LogTable<Frame>& t) {
  const LabelledAxis muscles{static_cast<hsize_t>(model.muscles.size()), muscle_labels};
  const std::string since =
      " for the mean of u + f_thigmo over the steps since the frame before, at the frame's q; nan "
      "at the first frame";
  t.numbers(
      "/muscle/activation", {muscles}, {"1", "least activations, 0 to 1," + since},
      [](const Frame& f) -> const auto& { return f.muscles.activation; });
  t.numbers(
      "/muscle/residual", {dofs_of(model)},
      {"dyn, dyn·cm", "what they fall short of, torque - R a F_max, 0 at the root," + since},
      [](const Frame& f) -> const auto& { return f.muscles.residual; });
}

/// /flesh: how the body is pressed.
void declare_flesh(const Model& model, const Scene& scene, LogTable<Frame>& t) {
  const LabelledAxis n{static_cast<hsize_t>(model.body_count()), body_labels};
  const auto along = [&](const char* name, const char* unit, const char* description, int row) {
    t.numbers(std::string("/flesh/") + name, {n}, {unit, description},
              [model, settings = scene.flesh, row](const Frame& f) -> Eigen::VectorXd {
                const Observation& seen = f.record.after.observation;
                return flesh_along(model, settings, seen.kin, seen.flesh).row(row);
              });
  };
  along("overlap", "cm", "deepest overlap of skins, or with an obstacle, at each body", 0);
  along("pressure", "dyn/cm²",
        "pressure at rest there: stiffness times overlap over the width of the overlap", 1);
  t.number("/flesh/energy", {"erg", "energy stored in flesh, a part of elastic_energy"},
           [](const Frame& f) { return f.record.after.observation.flesh.energy; });
}

/// /pull: what the head's pull at food comes to, of the means above.
void declare_pull(LogTable<Frame>& t) {
  const std::string when =
      ", mean over the steps since the frame before; nan unless this frame and that one are of the "
      "pull";
  const auto number = [&](const char* name, const char* unit, const char* description,
                          double PullFigures::*member) {
    t.number(std::string("/pull/") + name, {unit, description + when},
             [member](const Frame& f) { return pull_figures_of(f).*member; });
  };
  number("force", "dyn", "pull of the head at the food: the head clamp's force, along -x",
         &PullFigures::force);
  number("plate", "dyn", "force of the head plate on the knot, along +x", &PullFigures::plate);
  t.numbers("/pull/bearing", {on_plate},
            {"cm", "y and z of the point of the head plate at which its force acts" + when},
            [](const Frame& f) { return pull_figures_of(f).bearing; });
  number("torque", "dyn·cm", "largest torque of a hinge, active and f_thigmo",
         &PullFigures::torque);
  number("advantage_rows", "1", "pull over the sum of the multipliers over h of the rows of Eq. 6",
         &PullFigures::advantage_rows);
  number("advantage_torque", "1/cm", "pull over the largest torque of a hinge",
         &PullFigures::advantage_torque);
}

void declare_diagnostics(LogTable<Frame>& t) {
  const std::string path = "/diagnostics/";
  t.choice(path + "solve", {solve_kind_names.begin(), solve_kind_names.end()},
           "least that the step had to solve",
           [](const Frame& f) { return f.record.solution.kind; });
  t.count(path + "rows", "rows in the problem",
          [](const Frame& f) { return f.record.solution.rows.size(); });
  t.count(path + "active", "rows with a force",
          [](const Frame& f) { return f.record.solution.active; });
  t.count(path + "contacts", "local minima of the gap within the margin",
          [](const Frame& f) { return f.record.after.observation.contact.contacts.size(); });
  t.count(path + "iterations", "iterations of the QP back end",
          [](const Frame& f) { return f.record.solution.iterations; });
  t.number(path + "kkt_stationarity",
           {"1",
            "|H (qdot_next - qdot*) - h sum of forces|, infinity norm over the largest momentum, "
            "also of one kind of force alone"},
           [](const Frame& f) { return f.record.solution.stationarity; });
  t.number(path + "kkt_primal", {"1", "row violation, scaled, infinity norm"},
           [](const Frame& f) { return f.record.solution.kkt.primal; });
  t.number(path + "kkt_complementarity", {"1", "multiplier times excess, scaled, infinity norm"},
           [](const Frame& f) { return f.record.solution.kkt.complementarity; });
  t.number(path + "kkt_worst", {"1", "largest of the three at any step since the last frame"},
           [](const Frame& f) { return f.worst.kkt; });
  t.number(path + "penetration", {"cm", "deepest at any step since the last frame"},
           [](const Frame& f) { return f.worst.penetration; });
  t.number(path + "skin_fold",
           {"1",
            "largest radius of the skin over radius of curvature across one diameter of the body: "
            "above 1 the skin inside of a bend folds into itself"},
           [](const Frame& f) { return f.skin_fold; });
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
  visit_energies([&t](const std::string& name, const std::string& description, const auto& of) {
    t.number("/diagnostics/" + name, {"erg", description},
             [of](const Frame& f) { return of(f.record.ledger); });
  });
  t.number("/diagnostics/integrator_error", {"erg", "sum of the integrator's terms"},
           [](const Frame& f) { return f.record.ledger.integrator_error(); });
}

void declare_momentum(LogTable<Frame>& t) {
  for (const MomentumColumn& column : momentum_columns) {
    const auto vector = [&](const char* name, const char* unit, const char* about,
                            Eigen::Vector3d Momentum::*part) {
      t.numbers(
          std::string("/diagnostics/") + name, {space},
          {unit, column.description + about + ", world axes"},
          [ part, member = column.member ](const Frame& f) -> const auto& {
            return f.record.momentum.*member.*part;
          });
    };
    vector(column.linear, column.unit, "", &Momentum::linear);
    vector(column.angular, column.angular_unit, ": about the centre of mass", &Momentum::angular);
  }
}

}  // namespace

void Worst::take(const StepRecord& record) {
  penetration = std::max(penetration, record.after.observation.penetration);
  limit_violation = std::max(limit_violation, record.after.observation.limit_violation);
  head_drift = std::max(head_drift, record.head_drift);
  // Nan where a step has none (of another simulator), and then of the whole frame.
  const double residual = record.solution.worst_residual();
  kkt = residual <= kkt ? kkt : residual;
}

LogTable<Frame> frame_table(const Model& model, const Scene& scene, LogLevel level) {
  const bool full = level == LogLevel::full;
  LogTable<Frame> table({level, frame_labels, full ? frame_chunk_rows : packed_frames, !full});
  declare_trajectory(model, table);
  if (scene.time.rule == TimeRule::midpoint) declare_midway(model, table);
  declare_knot(table);
  declare_forces(model, table);
  declare_thigmotaxis(table);
  if (scene.controller.law == own_law) declare_control(model, table);
  declare_memory(model, scene, table);
  declare_means(model, table);
  if (scene.muscle.present) declare_muscles(model, table);
  if (scene.flesh.present()) declare_flesh(model, scene, table);
  declare_pull(table);
  declare_diagnostics(table);
  declare_energy(table);
  declare_momentum(table);
  return table;
}

}  // namespace hagfish
