#include "experiments/live/live_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/control/laws.hpp"
#include "experiments/view/along_body.hpp"

namespace hagfish {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
template <class Values>
std::vector<double> list(const Values& values) {
  std::vector<double> all;
  for (const double value : values.reshaped()) all.push_back(value);
  return all;
}

/// A contact that bears: where skins meet, the push on strand a, its size, arcs.
struct Bearing {
  Eigen::Vector3d point, normal;
  double force, arc_a, arc_b;
};

std::vector<Bearing> bearing_contacts(const Model& model, const StepRecord& record, double h) {
  std::vector<Bearing> found;
  const double length = body_length(model);
  const Eigen::Matrix3Xd& centre = record.after.observation.kin.centre;
  for (std::size_t i = 0; i < record.solution.rows.size(); ++i) {
    const Row& row = record.solution.rows[i];
    const double force = record.solution.lambda[static_cast<Eigen::Index>(i)] / h;
    const bool touches = row.kind == RowKind::contact || row.kind == RowKind::obstacle;
    if (!touches || !(force > 0)) continue;
    const BetweenPoints& at = row.points();
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int k = 0; k < at.a.count; ++k) {
      point += at.a.weight[k] * centre.col(at.a.first + k);
    }
    const int segment =
        std::min(static_cast<int>(at.a.parameter), std::max(0, model.body_count() - 2));
    const double t = at.a.parameter - segment;
    const double radius =
        (1 - t) * model.bodies[segment].radius + t * model.bodies[segment + 1].radius;
    found.push_back({point - radius * at.direction, at.direction, force,
                     (at.a.parameter + 0.5) * length,
                     row.kind == RowKind::contact ? (at.b.parameter + 0.5) * length : nan});
  }
  return found;
}

/// Force per length, dyn/cm, at the bodies.
std::vector<double> contact_along(const Model& model, const std::vector<Bearing>& contacts) {
  std::vector<double> along(static_cast<std::size_t>(model.body_count()), 0.0);
  for (const Bearing& c : contacts) {
    for (const double arc : {c.arc_a, c.arc_b}) {
      if (std::isfinite(arc)) spread_contact(model, c.force, arc, along);
    }
  }
  return along;
}

TipForce force_of(const Pull& pull, const Scene& scene, const Kinematics& kin) {
  const double h = scene.time.reach();
  const Eigen::Vector3d position = kin.centre.col(pull.body);
  const Eigen::Vector3d velocity = kin.centre_velocity.col(pull.body);
  TipForce spring{pull.stiffness * (pull.to - position), h * pull.stiffness, pull.body};
  const Eigen::Vector3d expected = spring.value - spring.rate * velocity;
  const double size = expected.norm();
  if (size <= pull.most) return spring;
  return {pull.most / size * expected, 0, pull.body};
}

}  // namespace

LiveRun::LiveRun(ResolvedScene resolved)
    : resolved_(std::move(resolved)),
      sim_(start(model_, resolved_.scene, "active-set")),
      means_(model_.nv()),
      moments_(model_),
      slides_(model_) {
  hold_pull();
}

void LiveRun::hold_pull() {
  pulled_scene_ = resolved_.scene;
  pulled_scene_.controller.law = own_law;
  for (const RowKind kind : row_kinds) record_.solution.force[kind].setZero(model_.nv());
}

void LiveRun::change(ResolvedScene resolved) {
  change_scene(resolved.model, resolved_.scene, resolved.scene, sim_);
  resolved_ = std::move(resolved);
  hold_pull();
}

int LiveRun::advance(int count) {
  const Scene& scene = resolved_.scene;
  int taken = 0;
  for (; taken < count && !over(); ++taken) {
    sim_.law = {};
    if (pull_) {
      sim_.law = [this](const Situation& at, Eigen::VectorXd& memory, Control& control) {
        ask_law({at.model, resolved_.scene, at.now, at.time, at.so_far}, memory, control,
                named_law_);
        control.tip = force_of(*pull_, resolved_.scene, at.now.observation.kin);
      };
    }
    take_step(model_, pull_ ? pulled_scene_ : scene, sim_, record_);
    means_.take(record_, thigmotaxis_rows_of(record_.control, record_.solution, scene.time.step));
    moments_.take(model_, scene.time, record_);
    for (const std::string& warning : record_.warnings) warnings_ += warning + "\n";
  }
  return taken;
}

std::string LiveRun::take_warnings() { return std::exchange(warnings_, {}); }

void LiveRun::put(std::string_view name, std::vector<double> values) {
  if (filled_ == arrays_.size()) arrays_.emplace_back();
  arrays_[filled_++] = {name, std::move(values)};
}

std::span<const LiveArray> LiveRun::frame() {
  filled_ = 0;
  const Scene& scene = resolved_.scene;
  const State& state = sim_.now.state;
  const Observation& seen = sim_.now.observation;
  const ControllerState& controller = sim_.controller;
  const FrameMeans& mean = means_.close();
  const JointMoments& moments = moments_.close();
  const bool moved = sim_.step > 0;
  const auto span = knot_span(controller);
  put("time", {time_of(sim_, scene)});
  put("q", list(state.q));
  put("position", list(seen.kin.centre));
  put("phase", {static_cast<double>(controller.phase)});
  put("knot", {static_cast<double>(controller.knot.type.determinant),
               static_cast<double>(controller.knot.type.v2)});
  put("clamped", {clamps_head(scene, controller.phase) ? 1.0 : 0.0});
  put("ends", {span ? span->head_end : nan, span ? span->tail_end : nan});
  slides_.see(controller.phase, span, state.q);
  const Slide slide = slides_.slide();
  put("slide", {slide.leading_way, slide.trailing_way, slide.taper_asks, slide.travel});
  put("over", {over() ? 1.0 : 0.0});
  put("penetration", {seen.penetration});
  const auto zero = [&](const Eigen::VectorXd& force) {
    return moved && force.allFinite() ? force : Eigen::VectorXd(Eigen::VectorXd::Zero(model_.nv()));
  };
  const Eigen::VectorXd head = zero(mean.force[RowKind::head]);
  put("head", list(head.head<6>()));
  put("plate", {zero(mean.force[RowKind::obstacle])[0]});
  const Eigen::Vector3d tip = moved ? record_.solution.tip : Eigen::Vector3d::Zero();
  put("tip", list(pull_ ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : tip));
  put("hand", list(pull_ ? tip : Eigen::Vector3d(Eigen::Vector3d::Zero())));
  const auto four = [](const std::array<double, 4>& of) {
    return std::vector<double>(of.begin(), of.end());
  };
  put("speed", four(mean.speed));
  put("slack", four(mean.slack));
  put("lambda", four(mean.lambda));
  const ThigmotaxisRows rows =
      moved ? thigmotaxis_rows_of(record_.control, record_.solution, scene.time.step)
            : ThigmotaxisRows{.command = {nan, nan, nan, nan}};
  put("command", four(rows.command));
  const EnergyLedger& ledger = sim_.ledger;
  put("energy", {ledger.kinetic, ledger.elastic, ledger.work_tip, ledger.work_active,
                 ledger.work[RowKind::thigmotaxis], ledger.dissipated});
  put("thigmotaxis", moments_along(model_, Turn::bend, moments.of_rows[RowKind::thigmotaxis]));
  put("active", moments_along(model_, Turn::bend, moments.active));
  put("curvature", shape_along(model_, Turn::bend, state.q));
  put("twist", shape_along(model_, Turn::twist, state.q));
  const std::vector<Bearing> contacts =
      moved ? bearing_contacts(model_, record_, scene.time.step) : std::vector<Bearing>{};
  put("contact", contact_along(model_, contacts));
  std::vector<double> numbers;
  for (const Bearing& c : contacts) {
    numbers.insert(numbers.end(), {c.point.x(), c.point.y(), c.point.z(), c.normal.x(),
                                   c.normal.y(), c.normal.z(), c.force, c.arc_a, c.arc_b});
  }
  put("contacts", std::move(numbers));
  return {arrays_.data(), filled_};
}

std::vector<LiveArray> LiveRun::animal() const {
  std::vector<double> radius;
  for (const Body& body : model_.bodies) radius.push_back(body.radius);
  const Scene& scene = resolved_.scene;
  return {{"length", {model_.length()}},
          {"radius", radius},
          {"arc", body_centres(model_)},
          {"bending", joint_arcs(model_, Turn::bend)},
          {"twisting", joint_arcs(model_, Turn::twist)},
          {"station", resolved_.specimen.station},
          {"wall", {scene.wall.present ? 1.0 : 0.0}},
          {"clock", {scene.time.step, scene.time.frame_interval, scene.time.duration}}};
}

}  // namespace hagfish
