#include "experiments/design/soft_body.hpp"

#include <cmath>
#include <limits>

#include "core/run/drive.hpp"
#include "core/step/outcome.hpp"
#include "experiments/common/specimen_files.hpp"
#include "experiments/design/knot_table.hpp"
#include "experiments/sweep/sweep.hpp"

namespace hagfish {
namespace {

constexpr double look = 0.4;  // s, between looks at the knot
constexpr int waypoints_ahead = 2;
constexpr double search_step = 0.02;  // s
constexpr double lasting = 1.0;       // s, that a knot must be there
constexpr double more_tail = 0.04;    // of the body, for which a later look is gone on from

/// The scene with a path.
Scene led_along(const SoftBody& body, const TailPath& path, double step) {
  Scene scene = body.scene;
  scene.script.waypoints = waypoints_of(path, body.model.length());
  scene.time.step = step;
  scene.expect.knot.clear();  // nothing is waited for
  scene.expect.types.clear();
  return scene;
}

/// Another animal's tail is led as that of the `paper`'s animal is. In water a force goes with
/// girth, speed and length. Stiffness goes with that force and the length squared.
void lead_like(ResolvedScene& resolved, const Specimen& paper) {
  const AnimalRatios beside = ratios(resolved.specimen, paper);
  const double force = beside.drag() * beside.length * beside.length;
  Scene& scene = resolved.scene;
  go_with_size(scene, beside);
  for (double* one : {&scene.script.spring, &scene.script.damper}) *one *= force / beside.length;
  scene.script.largest_force *= force;
  for (double* one : {&scene.model.bending_stiffness, &scene.model.bending_damping,
                      &scene.model.twist_stiffness, &scene.model.twist_damping}) {
    *one *= force * beside.length * beside.length;
  }
  resolved.model = make_hagfish(resolved.specimen, scene);
}

}  // namespace

std::optional<std::string> name_in_scene(const std::string& knot) {
  if (const std::optional<KnotFingerprint> full = fingerprint_called(knot)) {
    return knot_name(full->type);
  }
  if (!knot_called(knot)) return std::nullopt;
  return knot;
}

SoftBody soft_body(const std::string& specimen) {
  // Lengths that fit other animals too (living_overhand.toml says why these).
  const std::vector<std::string> set = {
      "contact.least_arc=1.8 D",      "wall.neck=0.07 L",         "controller.tail_through=0.02 L",
      "controller.release_at=0.04 L", "time.frame_interval=0.02", "time.duration=60.0"};
  constexpr const char* file = "specimen.toml";
  const std::string led = "base = \"overhand_waypoints\"\n";
  std::string text = led;
  if (!specimen.empty()) text += std::string("specimen = \"") + file + "\"\n";
  ResolvedScene resolved = read_scene_text(text, "design", set, {{file, specimen}});
  if (!specimen.empty()) lead_like(resolved, read_scene_text(led, "design").specimen);
  return resolved;
}

std::optional<KnotInvariants> Tying::tied() const {
  if (failed || path.pull.empty() || seen.back().to - seen.back().from < lasting) {
    return std::nullopt;
  }
  return seen.back().type;
}

std::optional<Tying> try_plan(const SoftBody& body, const PathPlan& plan, const std::string& wanted,
                              Draw& draw, const std::function<bool()>& interrupted) {
  const KnotInvariants wanted_type = *knot_called(*name_in_scene(wanted));
  Tying tying{.seen = {{}}, .path = plan.path};
  if (plan.reached) tying.seen = plan.reached->seen;
  TailPath& path = tying.path;
  Scene scene = led_along(body, path, search_step);
  scene.knot.interval = look;
  Simulation sim = plan.reached ? plan.reached->sim : start(body.model, scene, sweep_qp);
  StepRecord record;
  const auto centre = [&]() -> Eigen::Matrix3Xd {
    return sim.now.observation.kin.centre / body.model.length();
  };
  int strand = 0;
  std::size_t next = 0;
  while (true) {
    const double time = time_of(sim, scene);
    // A spline depends on the waypoint behind the next one. With both known ahead of time, a path
    // that is taken again leads the tail as it did before.
    if (path.pull.empty() && next < plan.turns.size() &&
        waypoints_after(path, time + scene.time.step) < waypoints_ahead) {
      add_turn(path, plan.turns[next++], centre(), strand);
      scene.script.waypoints = waypoints_of(path, body.model.length());
    }
    if (time >= path_end(path) + lasting) return tying;
    if (interrupted()) return std::nullopt;
    try {
      take_step(body.model, scene, sim, record);
    } catch (const std::exception&) {  // whatever it was, this path leads nowhere
      tying.failed = true;
      return tying;
    }
    const double seen_at = record.controller.knot_seen;
    if (!std::isfinite(seen_at) || seen_at == tying.seen.back().to) continue;
    if (record.controller.knot.type != tying.seen.back().type) {
      tying.seen.push_back({.type = record.controller.knot.type, .from = seen_at, .to = seen_at});
      continue;
    }
    TypeSeen& seen = tying.seen.back();
    seen.to = seen_at;
    if (!path.pull.empty() || tying.seen.size() < 2) continue;
    if (seen.type == wanted_type && is_knot(wanted, sim.now.observation.kin.centre, scene.knot)) {
      end_with_pull(path, time_of(sim, scene), centre(), draw);
      scene.script.waypoints = waypoints_of(path, body.model.length());
    } else if (waypoints_after(path, seen_at + search_step) >= waypoints_ahead) {
      const double left = tail_left(sim.now.observation.kin.centre, seen.type, scene.knot);
      if (seen.at > 0 && left < seen.left + more_tail) continue;
      seen.at = seen_at;
      seen.left = left;
      Reached here{sim, path, tying.seen};
      for (TypeSeen& before : here.seen) before.reached.reset();
      seen.reached = std::make_shared<Reached>(std::move(here));
    }
  }
}

TailPath path_reached(const TailPath& path, double at) {
  return path_with_ahead(path, at + search_step, waypoints_ahead);
}

double tail_left(const Eigen::Matrix3Xd& centre, const KnotInvariants& type,
                 const KnotSettings& settings) {
  KnotSettings few = settings;
  few.votes = 5;
  const Eigen::Index bodies = centre.cols();
  Eigen::Index cut = 0;
  for (Eigen::Index more = bodies / 4; more > 1; more /= 2) {
    if (knot_type(centre.leftCols(bodies - cut - more), few).type == type) cut += more;
  }
  return static_cast<double>(cut) / static_cast<double>(bodies);
}

namespace {

/// Shapes of a body in `scene` until it is finished or `until` (s); `sim`: then.
Shapes shapes_in(const SoftBody& body, const Scene& scene, double until, Simulation& sim) {
  Shapes shapes;
  std::vector<Eigen::VectorXd> q;
  StepRecord record;
  const auto keep = [&](const StepRecord& step, const Simulation&) {
    shapes.time.push_back(step.time);
    q.push_back(step.after.state.q);
  };
  try {
    const Status end =
        drive(body.model, scene, sim, record, {keep}, [&] { return time_of(sim, scene) >= until; });
    if (end.outcome != Outcome::stopped) shapes.failure = end.message;
  } catch (const std::exception& error) {
    shapes.failure = error.what();
  }
  shapes.q.resize(static_cast<Eigen::Index>(q.size()), body.model.nq());
  for (std::size_t k = 0; k < q.size(); ++k) shapes.q.row(static_cast<Eigen::Index>(k)) = q[k];
  return shapes;
}

}  // namespace

Shapes led_shapes(const SoftBody& body, const TailPath& path, double until) {
  const Scene scene = led_along(body, path, search_step);
  Simulation sim = start(body.model, scene, sweep_qp);
  return shapes_in(body, scene, until, sim);
}

Shapes tied_shapes(const SoftBody& body, const TailPath& path, const std::string& wanted) {
  Scene scene = led_along(body, path, search_step);
  scene.expect.knot = *name_in_scene(wanted);
  scene.controller.tighten_from = path_end(path);
  scene.time.until = Phase::form;
  Simulation sim = start(body.model, scene, sweep_qp);
  Shapes shapes = shapes_in(body, scene, std::numeric_limits<double>::infinity(), sim);
  if (shapes.failure.empty() && !is_knot(wanted, sim.now.observation.kin.centre, scene.knot)) {
    shapes.failure = "it is no longer a " + wanted;
  }
  return shapes;
}

}  // namespace hagfish
