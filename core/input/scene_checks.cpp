#include "core/input/scene_parts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/chain/model.hpp"
#include "core/chain/start.hpp"
#include "core/contact/observation.hpp"
#include "core/contact/obstacles.hpp"
#include "core/control/laws.hpp"
#include "core/input/toml/toml_range.hpp"
#include "core/knot/knot.hpp"

namespace hagfish {
namespace {

void check_stations(const TableReader& root, const std::string& key,
                    const std::vector<Eigen::Vector4d>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double before = i == 0 ? 0 : rows[i - 1][0];
    if (rows[i][0] < before || rows[i][0] > 1 || (i > 0 && rows[i][0] == before)) {
      root.fail_element(
          key, i, "stations must rise from 0 to 1; row " + std::to_string(i + 1) + " does not");
    }
  }
}

void check_start(const TableReader& root, const ResolvedScene& resolved) {
  const StartSettings& start = resolved.scene.start;
  check_stations(root, "start.bend", start.bend);
  check_stations(root, "start.bend_rate", start.bend_rate);
  if (resolved.scene.clamp_head && !start.spin.isZero(0)) {
    root.fail("start.spin", "must be 0, since the head is clamped (clamp_head)");
  }
  if (!start.q.empty() && !start.bend.empty())
    root.fail("start.q", "start.bend is also given; give only one");
  if (resolved.scene.mirror && (!start.q.empty() || !start.qdot.empty() || start.noise > 0)) {
    root.fail("mirror", "start.q, start.qdot and start.noise_deg cannot be mirrored");
  }
  if (!start.qdot.empty() && (!start.bend_rate.empty() || !start.spin.isZero(0))) {
    root.fail("start.qdot", "start.bend_rate or start.spin is also given; give only one");
  }
  const Model& model = resolved.model;
  const auto check_length = [&](const std::string& key, const std::vector<double>& x, int length) {
    if (!x.empty() && static_cast<int>(x.size()) != length) {
      root.fail(key, "has " + std::to_string(x.size()) + " numbers; " +
                         std::to_string(model.body_count()) + " bodies need " +
                         std::to_string(length));
    }
  };
  check_length("start.q", start.q, model.nq());
  check_length("start.qdot", start.qdot, model.nv());
  if (!start.q.empty() && Eigen::Vector4d::Map(start.q.data() + 3).isZero(0)) {
    root.fail("start.q", "numbers 4 to 7 are a quaternion and must not all be 0");
  }
}

void check_passive(const TableReader& root, const ResolvedScene& resolved) {
  const Specimen& s = resolved.specimen;
  if (resolved.scene.model.passive != PassiveSource::specimen) return;
  for (const auto& [key, values] : {std::pair("bending_stiffness", &s.bending_stiffness),
                                    {"bending_damping", &s.bending_damping},
                                    {"twist_stiffness", &s.twist_stiffness},
                                    {"twist_damping", &s.twist_damping}}) {
    if (values->empty()) {
      root.fail("model.passive", "the specimen has no passive." + std::string(key));
    }
  }
}

void check_active(const TableReader& root, const Scene& scene) {
  if (scene.script.kind != ScriptSettings::Kind::curvature) return;
  const ActiveSettings& active = scene.active;
  for (const auto& [key, value] : {std::pair("active.stiffness", active.stiffness),
                                   {"active.tone_time", active.tone_time},
                                   {"active.relax_time", active.relax_time},
                                   {"active.capacity", active.capacity}}) {
    if (value == 0) root.fail(key, "must be positive where a curvature program bends the animal");
  }
  const double end = scene.script.curvature.time.back();
  if (end < scene.controller.tighten_from) {
    root.fail("controller.tighten_from",
              "the curvature program ends earlier, at " + shortest(end) + " s");
  }
}

void check_muscles(const TableReader& root, const ResolvedScene& resolved) {
  if (!resolved.scene.muscle.present) return;
  const MuscleTissue& tissue = resolved.specimen.muscle;
  for (const auto& [key, area] : {std::pair("longitudinal_area", &tissue.longitudinal_area),
                                  {"oblique_area", &tissue.oblique_area}}) {
    if (area->empty()) {
      root.fail("muscle.present", "the specimen has no muscle." + std::string(key));
    }
  }
  for (const auto& [key, value] : {std::pair("stress", tissue.stress),
                                   {"radius_share", tissue.radius_share},
                                   {"oblique_angle", tissue.oblique_angle}}) {
    if (value == 0) {
      root.fail("muscle.present", "the specimen's muscle." + std::string(key) +
                                      " is 0 or missing, but must be positive");
    }
  }
}

void check_law(const TableReader& root, const ResolvedScene& resolved) {
  const Law& law = law_of(resolved.scene);
  if (law.fault == nullptr) return;
  const std::optional<SceneFault> fault = law.fault(resolved.specimen, resolved.scene);
  if (!fault) return;
  if (fault->element) root.fail_element(fault->key, *fault->element, fault->why);
  root.fail(fault->key, fault->why);
}

void check_food(const TableReader& root, const Scene& scene) {
  const FoodSettings& food = scene.food;
  if (food.hold == 0) return;
  const Phase free_from = scene.controller.free_from;
  if (!scene.clamp_head) root.fail("food.hold", "food needs a clamped head (clamp_head = true)");
  if (phase_order(free_from) <= phase_order(Phase::pull)) {
    root.fail("food.hold", "food needs a clamped head, but controller.free_from = \"" +
                               std::string(phase_name(free_from)) + "\" frees it");
  }
  if (!scene.wall.present && scene.obstacles.empty()) {
    root.fail("food.hold",
              "food needs a head plate (wall.present = true) or an obstacle for the knot to press "
              "against");
  }
  if (scene.controller.leave_by == BodyEnd::tail) {
    root.fail("food.hold",
              "a knot that pulls at food cannot leave by the tail (controller.leave_by)");
  }
  if (food.cap.from == 0) root.fail("food.cap.from", "must be positive where there is food");
  if (food.cap.to < food.cap.from) {
    root.fail("food.cap.to", "must not be less than food.cap.from, " + shortest(food.cap.from));
  }
}

/// No slit between two strands that follow each other in the scene is so narrow that a section
/// could not get through with the area that is left of it at least: a stadium of width w has the
/// share 1 - (1 - w/d)² of a circle's. Strands that touch leave no slit.
void check_slits(const TableReader& root, const ResolvedScene& resolved,
                 const std::vector<SplineSegment>& segments) {
  const Model& model = resolved.model;
  const double thickest = 2 * std::ranges::max(model.bodies, {}, &Body::radius).radius;
  const double least = thickest * (1 - std::sqrt(1 - resolved.specimen.flesh.least_area));
  for (const SplineSegment& a : segments) {
    for (const SplineSegment& b : segments) {
      if (a.obstacle < 0 || b.obstacle != a.obstacle + 1 || std::isnan(a.bound + b.bound)) continue;
      const double width = closest_points(a, b).gap;
      if (width <= 0 || width >= least) continue;
      root.fail("obstacle", "the slit of " + shortest(width) + " cm between the " +
                                model.obstacles[a.obstacle].name + " and the " +
                                model.obstacles[b.obstacle].name +
                                " is too narrow for the volume of the body, which passes " +
                                shortest(least) + " cm (specimen.flesh.least_area)");
    }
  }
}

void check_flesh(const TableReader& root, const ResolvedScene& resolved) {
  const FleshSettings& flesh = resolved.scene.flesh;
  const std::vector<double>& range = resolved.specimen.flesh.stiffness_range;
  if (!range.empty() && (range.size() != 2 || range[0] > range[1])) {
    root.fail("specimen", "its flesh.stiffness_range must be two values that rise");
  }
  if (!flesh.present()) return;
  for (const auto& [key, value] :
       {std::pair("flesh.relaxation", flesh.relaxation), {"flesh.spacing", flesh.spacing}}) {
    if (value == 0) root.fail(key, "must be positive where flesh.stiffness is");
  }
}

/// No obstacle but the head plate, which a neck may be in, overlaps the body at the start, except
/// that flesh may.
void check_obstacles(const TableReader& root, const ResolvedScene& resolved) {
  const Scene& scene = resolved.scene;
  if (scene.obstacles.empty()) return;
  const Model& model = resolved.model;
  const Observation seen = observe(model, start_state(model, scene.start), scene);
  if (scene.flesh.present()) {
    check_slits(root, resolved, seen.segments);
    return;
  }
  const auto check = [&](int obstacle, int body, double gap) {
    const int index = obstacle - (scene.wall.present ? 1 : 0);
    if (index >= 0 && gap < -scene.constraints.tolerance) {
      root.fail_element("obstacle", static_cast<std::size_t>(index),
                        "the " + model.obstacles[obstacle].name + " overlaps body " +
                            std::to_string(body) + " at the start by " + shortest(-gap) + " cm");
    }
  };
  for (const Contact& contact : seen.contact.on_obstacles) {
    check(contact.obstacle, contact.body_a(), contact.gap);
  }
  visit_plane_gaps(model, seen.kin,
                   [&](const PlaneGap& at) { check(at.obstacle, at.body, at.gap); });
}

void check_times(const TableReader& root, const TimeSettings& time) {
  const std::string step = "must not be less than time.step, " + shortest(time.step);
  if (time.frame_interval < time.step) root.fail("time.frame_interval", step);
  if (time.duration < time.step) root.fail("time.duration", step);
  // A frame or a run of more than 1e9 steps is taken for an error.
  const double steps = time.frame_interval / time.step;
  if (steps > 1e9 || std::abs(steps - std::round(steps)) > 1e-9 * steps) {
    root.fail("time.frame_interval",
              "must be a whole multiple of time.step, " + shortest(time.step));
  }
  if (time.duration / time.step > 1e9) {
    root.fail("time.duration", "must be at most 1e9 times time.step, " + shortest(time.step));
  }
}

/// Whether two times follow each other, as far as that can be said before the run.
bool in_order(const RunTime& a, const RunTime& b) {
  if (a.after && b.after) {
    const int first = phase_order(*a.after), second = phase_order(*b.after);
    return first < second || (first == second && a.time <= b.time);
  }
  return a.after || b.after || a.time <= b.time;
}

void check_expectations(const TableReader& root, const Scene& scene) {
  const auto known = [](const std::string& name) { return knot_called(name).has_value(); };
  const std::string names = "must be the name of a knot, 3_1 to 7_7 or det=D,v2=V";
  if (!scene.expect.knot.empty() && (!known(scene.expect.knot) || scene.expect.knot == "0_1")) {
    root.fail("expect.knot", names + ", or empty for none");
  }
  const std::vector<KnotStretch>& types = scene.expect.types;
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (!known(types[i].type)) {
      root.fail_element("expect.types", i, "type " + names + ", or 0_1 for none");
    }
    if (std::isnan(types[i].from.time) || std::isnan(types[i].to.time)) {
      root.fail_element("expect.types", i,
                        "a time must be in s, a phase as in \"release\", later as in "
                        "\"free + 0.5\", or \"end\"");
    }
    const RunTime start;
    if (!in_order(types[i].from, types[i].to) ||
        !in_order(i > 0 ? types[i - 1].to : start, types[i].from)) {
      root.fail_element("expect.types", i, "times must rise");
    }
  }
  const auto is_called = [&](const Obstacle& one) {
    return one.plane() != nullptr && one.name == scene.expect.out_of;
  };
  if (!scene.expect.out_of.empty() && std::ranges::none_of(obstacles_of(scene), is_called)) {
    root.fail("expect.out_of", "must be the name of a plane that is an obstacle, or empty");
  }
  if (scene.controller.contact_gap > scene.contact.margin) {
    root.fail("controller.contact_gap",
              "must not exceed contact.margin, " + shortest(scene.contact.margin));
  }
  if (scene.controller.contact_gap == 0 && scene.controller.contact_patch > 0) {
    root.fail("controller.contact_gap", "must be positive where controller.contact_patch is");
  }
}

}  // namespace

void check_scene(const TableReader& root, ResolvedScene& resolved) {
  check_passive(root, resolved);
  check_muscles(root, resolved);
  resolved.model = make_hagfish(resolved.specimen, resolved.scene);
  check_start(root, resolved);
  check_active(root, resolved.scene);
  check_law(root, resolved);
  check_food(root, resolved.scene);
  check_flesh(root, resolved);
  check_obstacles(root, resolved);
  check_times(root, resolved.scene.time);
  check_expectations(root, resolved.scene);
}

}  // namespace hagfish
