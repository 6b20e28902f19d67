// The keys of scene and specimen files, once for all who visit them: `Io` is TableReader,
// TomlWriter or FieldVisitor (experiments/common/idle_settings.cpp).
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/control/laws.hpp"
#include "core/input/csv/program_table.hpp"
#include "core/input/run_time_text.hpp"
#include "core/input/toml/toml_range.hpp"
#include "core/scene/settings.hpp"
#include "core/scene/specimen.hpp"

namespace hagfish {

struct ActingKey;
/// When anything reads a field.
struct Acts {
  bool here = true;                 ///< whether anything does in this scene
  std::string unless = {};          ///< the reason where nothing does
  std::optional<Phase> until = {};  ///< the last phase that reads it

  ActingKey operator()(std::string_view key) const;
};

/// The key of a field that does not act everywhere.
struct ActingKey {
  std::string_view key;
  Acts acts;

  operator std::string_view() const { return key; }
};
inline ActingKey Acts::operator()(std::string_view key) const { return {key, *this}; }

enum class WaypointUnit { unsaid, dyn, newton, cm, metre, body_length };

/// Unit of the noise of a script's waypoints.
inline Unit waypoint_unit(ScriptSettings::Kind kind) {
  using Kind = ScriptSettings::Kind;
  return kind == Kind::force ? cgs::dyn : kind == Kind::position ? cgs::cm : cgs::one;
}

/// A script as its file spells it: waypoints in rows [t, x, y, z], in `unit`.
struct ScriptFile {
  ScriptSettings settings;  ///< all but the waypoints
  WaypointUnit unit = WaypointUnit::unsaid;
  std::vector<Eigen::Vector4d> rows;
  std::string program;  ///< CSV file of a curvature program, or empty
  ProgramTable curvature;
};

/// An obstacle as its file spells it: a ring is a closed strand by another name.
struct ObstacleFile {
  enum class Kind { plane, strand, ring };
  std::string name;
  Kind kind = Kind::plane;
  Plane plane;
  Strand strand;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::UnitX();
  double inner_radius = 0;  ///< radius of the hole, cm
};

template <class Io>
void specimen_fields(Io& io, Specimen& s) {
  io.string("name", s.name);
  io.number("length", s.length, positive(cgs::cm));
  io.number("mass", s.mass, positive(cgs::gram));
  io.numbers("station", s.station, within(0, 1));
  io.numbers("circumference", s.circumference, positive(cgs::cm));
  io.angles("bending_limit", s.bending_limit, inside(0, 180));
  io.number("bending_span", s.bending_span, positive(cgs::cm));
  io.angle("twist_limit", s.twist_limit, positive());
}

/// Keys that a specimen may leave out.
template <class Io>
void passive_fields(Io& io, Specimen& s) {
  io.table("passive", [&s](Io& table) {
    table.numbers("bending_stiffness", s.bending_stiffness, not_negative(cgs::rigidity));
    table.numbers("bending_damping", s.bending_damping, not_negative(cgs::damping));
    table.numbers("twist_stiffness", s.twist_stiffness, not_negative(cgs::rigidity));
    table.numbers("twist_damping", s.twist_damping, not_negative(cgs::damping));
  });
}

template <class Io>
void muscle_tissue_fields(Io& io, Specimen& s) {
  io.table("muscle", [&tissue = s.muscle](Io& table) {
    table.numbers("longitudinal_area", tissue.longitudinal_area, positive(cgs::cm2));
    table.numbers("oblique_area", tissue.oblique_area, positive(cgs::cm2));
    table.number("stress", tissue.stress, not_negative(cgs::stress));
    table.number("radius_share", tissue.radius_share, within(0, 1));
    table.angle("oblique_angle", tissue.oblique_angle, within(0, 80));
  });
}

template <class Io>
void flesh_tissue_fields(Io& io, Specimen& s) {
  io.table("flesh", [&tissue = s.flesh](Io& table) {
    table.numbers("stiffness_range", tissue.stiffness_range, positive(cgs::stress));
    table.number("least_area", tissue.least_area, within(0, 1));
  });
}

template <class Io>
void model_fields(Io& io, ModelSettings& s) {
  io.integer("bodies", s.bodies, within(2, 400));
  io.template choice<JointLayout>(
      "joints", s.joints,
      {{"alternating", JointLayout::alternating}, {"universal", JointLayout::universal}});
  io.template choice<PassiveSource>(
      "passive", s.passive,
      {{"scene", PassiveSource::scene}, {"specimen", PassiveSource::specimen}});
  const Acts own{s.passive == PassiveSource::scene,
                 "model.passive = \"specimen\": the animal's own values are used"};
  io.number(own("bending_stiffness"), s.bending_stiffness, not_negative(cgs::rigidity));
  io.number(own("bending_damping"), s.bending_damping, not_negative(cgs::damping));
  io.number(own("twist_stiffness"), s.twist_stiffness, not_negative(cgs::rigidity));
  io.number(own("twist_damping"), s.twist_damping, not_negative(cgs::damping));
  io.angle("largest_limit", s.largest_limit, inside(0, 90));
  io.number("limit_scale", s.limit_scale, positive());
  io.number("mass_ratio", s.mass_ratio, positive());
  io.template choice<BendingLimit>("bending_limit", s.bending_limit,
                                   {{"box", BendingLimit::box}, {"cone", BendingLimit::cone}});
}

/// Phases as choices, by the names that logs have: those from `first` on, in the order of time.
inline Choices<Phase> phases_from(Phase first, bool with_optional) {
  Choices<Phase> choices;
  for (const PhaseEntry& phase : phase_table) {
    if (phase_order(phase.value) >= phase_order(first) && (with_optional || !phase.optional)) {
      choices.emplace_back(phase.name, phase.value);
    }
  }
  return choices;
}

template <class Io>
void start_fields(Io& io, StartSettings& s) {
  io.rows("bend", "row", "station, x, y, z", s.bend, cgs::curvature);
  io.rows("bend_rate", "row", "station, x, y, z", s.bend_rate, cgs::curvature);
  io.vector("spin", s.spin);
  io.only_cgs({"q", "qdot"});  // of many units
  io.numbers("q", s.q, any_number());
  io.numbers("qdot", s.qdot, any_number());
  io.angle("noise", s.noise, not_negative());
  io.integer(Acts{s.noise != 0, "start.noise_deg is 0"}("seed"), s.seed, any_number());
  io.choice("phase", s.phase, phases_from(Phase::form, false));
}

template <class Io>
void constraint_fields(Io& io, ConstraintSettings& s) {
  io.template choice<Activation>(
      "activation", s.activation,
      {{"speculative", Activation::speculative}, {"violated", Activation::violated}});
  io.number("baumgarte", s.baumgarte, within(0, 1));
  io.number("baumgarte_speed", s.baumgarte_speed, positive(cgs::speed));
  io.number("tolerance", s.tolerance, not_negative(cgs::cm));
  const Acts speculative{s.activation == Activation::speculative,
                         "constraints.activation = \"violated\" corrects no step"};
  io.integer(speculative("corrections"), s.corrections, within(0, 100));
  io.number("stride", s.stride, at_least(1e-3, cgs::cm));  // finer, a path is cut for ever
}

template <class Io>
void obstacle_fields(Io& io, ObstacleFile& s) {
  using Kind = ObstacleFile::Kind;
  const auto require = [&io](std::initializer_list<const char*> keys) {
    for (const char* key : keys) io.require(key);
  };
  require({"kind"});
  io.string("name", s.name);
  io.template choice<Kind>(
      "kind", s.kind, {{"plane", Kind::plane}, {"strand", Kind::strand}, {"ring", Kind::ring}});
  if (s.kind == Kind::plane) {
    require({"point", "normal"});
    io.place("point", s.plane.point);
    io.vector("normal", s.plane.normal);
    io.length("neck", s.plane.neck, not_negative());
    return;
  }
  require({"radius"});
  io.length("radius", s.strand.radius, positive());
  if (s.kind == Kind::strand) {
    require({"points"});
    io.places("points", s.strand.points);
    io.boolean("closed", s.strand.closed);
  } else {
    require({"centre", "axis", "inner_radius"});
    io.place("centre", s.centre);
    io.vector("axis", s.axis);
    io.length("inner_radius", s.inner_radius, positive());
  }
}

template <class Io>
void script_fields(Io& io, ScriptFile& s) {
  using Kind = ScriptSettings::Kind;
  io.template choice<Kind>("kind", s.settings.kind,
                           {{"none", Kind::none},
                            {"force", Kind::force},
                            {"position", Kind::position},
                            {"curvature", Kind::curvature}});
  const Kind kind = s.settings.kind;
  const Acts script{kind != Kind::none, "script.kind is \"none\": there is no script"};
  const Acts curvature{kind == Kind::curvature, "only script.kind = \"curvature\" reads it"};
  const Acts position{kind == Kind::position, "only script.kind = \"position\" reads it"};
  const Acts waypoints = kind == Kind::curvature
                             ? Acts{false, "script.kind = \"curvature\" reads script.program"}
                             : script;
  io.number(position("spring"), s.settings.spring, not_negative(cgs::spring));
  io.number(position("damper"), s.settings.damper, not_negative(cgs::damper));
  io.number(position("largest_force"), s.settings.largest_force, not_negative(cgs::dyn));
  io.number(script("noise"), s.settings.noise, not_negative(waypoint_unit(kind)));
  io.integer(Acts{s.settings.noise != 0, "script.noise is 0"}("noise_seed"), s.settings.noise_seed,
             any_number());
  io.template choice<WaypointUnit>("unit", s.unit,
                                   {{"dyn", WaypointUnit::dyn},
                                    {"N", WaypointUnit::newton},
                                    {"cm", WaypointUnit::cm},
                                    {"m", WaypointUnit::metre},
                                    {"L", WaypointUnit::body_length}});
  io.rows(waypoints("knots"), "knot", "t, x, y, z", s.rows);
  io.string(curvature("program"), s.program);
  io.table(curvature("curvature"), [&s](Io& table) {
    table.numbers("times", s.curvature.times, not_negative());
    table.numbers("stations", s.curvature.stations, within(0, 1));
    table.numbers("bend_y", s.curvature.bend_y, any_number());
    table.numbers("bend_z", s.curvature.bend_z, any_number());
    table.numbers("twist", s.curvature.twist, any_number());
  });
}

template <class Io>
void active_fields(Io& io, Scene& scene) {
  ActiveSettings& s = scene.active;
  const Acts pulls{
      scene.script.kind == ScriptSettings::Kind::curvature || law_of(scene).bends,
      "no torque is active: script.kind is not \"curvature\", and controller.law asks for none"};
  io.number(pulls("stiffness"), s.stiffness, not_negative(cgs::rigidity));
  io.number(pulls("tone_time"), s.tone_time, not_negative());
  io.number(pulls("relax_time"), s.relax_time, not_negative());
  io.number("capacity", s.capacity, not_negative(cgs::dyn_cm));
  io.boolean("bounds_laws", s.bounds_laws);
}

template <class Io>
void reduced_basis_fields(Io& io, ReducedBasisSettings& s) {
  io.template choice<BasisFrame>("frame", s.frame,
                                 {{"body", BasisFrame::body}, {"knot", BasisFrame::knot}});
  io.length("margin", s.margin, not_negative());
  io.number("smooth", s.smooth, not_negative());
  io.integer("cosines", s.cosines, within(0, 100));
  io.string("file", s.file);
  const bool along_body = s.frame == BasisFrame::body;
  io.numbers("stations", s.stations, not_negative(along_body ? cgs::cm : cgs::one));
  io.numbers("bend_y", s.bend_y, any_number());
  io.numbers("bend_z", s.bend_z, any_number());
  io.numbers("twist", s.twist, any_number());
  io.number("period", s.period, not_negative());
  io.number("filter", s.filter, not_negative());
  io.number("softness", s.softness, not_negative());
  io.number("most", s.most, not_negative(cgs::dyn_cm));
  io.numbers("places", s.places, not_negative(cgs::cm));
  io.numbers("played", s.played, any_number(cgs::dyn_cm));
}

template <class Io>
void reflex_fields(Io& io, ReflexSettings& s) {
  io.length("shift", s.shift, any_number());
  io.length("pull_shift", s.pull_shift, any_number());
  io.boolean("bend_y", s.bend_y);
  io.boolean("bend_z", s.bend_z);
  io.boolean("twist", s.twist);
  io.template choice<ReflexGate>("gate", s.gate,
                                 {{"all", ReflexGate::all}, {"touch", ReflexGate::touch}});
  io.length("reach", s.reach, not_negative());
  io.number("delay", s.delay, not_negative());
  io.number("noise", s.noise, within(0, 10));
  io.integer(Acts{s.noise != 0, "controller.reflex.noise is 0"}("seed"), s.seed, any_number());
}

template <class Io>
void muscle_fields(Io& io, Scene& scene) {
  MuscleSettings& s = scene.muscle;
  io.boolean("present", s.present);
  const Acts driven{law_of(scene).drives_muscles, "controller.law drives no muscles"};
  io.number(driven("activation_time"), s.activation_time, not_negative());
}

template <class Io>
void controller_fields(Io& io, Scene& scene) {
  ControllerSettings& s = scene.controller;
  Choices<std::string> names;
  for (const Law* law : laws()) names.emplace_back(law->name, law->name);
  io.choice("law", s.law, names);
  const Law& law = law_of(scene);
  const Acts eq6{law.asks_for_eq6, "controller.law asks for no speeds of Eq. 6"};
  const Acts held{scene.clamp_head, "clamp_head is false: the head is never held"};
  const Acts forming{.until = Phase::form}, tightening{.until = Phase::tighten};
  io.template choice<Eq6Point>(eq6("eq6_at"), s.eq6_at,
                               {{"skin", Eq6Point::skin}, {"centreline", Eq6Point::centreline}});
  io.template choice<Eq6Slip>(eq6("eq6_slip"), s.eq6_slip,
                              {{"paper", Eq6Slip::paper}, {"shape", Eq6Slip::shape}});
  io.number(eq6("cap"), s.cap, positive(cgs::dyn));
  io.number("contact_gap", s.contact_gap, not_negative(cgs::cm));
  io.number("contact_patch", s.contact_patch, not_negative(cgs::cm));
  io.length(forming("tail_through"), s.tail_through, not_negative());
  io.number(forming("tighten_from"), s.tighten_from, not_negative());
  io.length(tightening("tight_span"), s.tight_span, positive());
  io.number(tightening("tight_hold"), s.tight_hold, not_negative());
  io.number(tightening("tighten_time"), s.tighten_time, not_negative());
  io.length("release_at", s.release_at, positive());
  io.number("untied_for", s.untied_for, not_negative());
  io.number("free_time", s.free_time, not_negative());
  io.template choice<BodyEnd>("leave_by", s.leave_by,
                              {{"head", BodyEnd::head}, {"tail", BodyEnd::tail}});
  io.choice(held("free_from"), s.free_from, phases_from(Phase::tighten, false));
  const auto speeds = [&](std::string_view key, Phase until, ThigmotaxisSpeeds& pair) {
    const Acts back{s.leave_by == BodyEnd::tail,
                    "controller.leave_by is \"head\": there is no slide to the tail"};
    Acts acts = key.starts_with("reverse") && !back.here ? back : eq6;
    acts.until = until;
    io.table(acts(key), [&pair](Io& table) {
      table.number("a", pair.a, any_number(cgs::speed));
      table.number("b", pair.b, any_number(cgs::speed));
    });
  };
  speeds("tighten_head", Phase::tighten, s.tighten_head);
  speeds("tighten_tail", Phase::tighten, s.tighten_tail);
  speeds("slide_head", Phase::release, s.slide_head);
  speeds("slide_tail", Phase::release, s.slide_tail);
  speeds("reverse_head", Phase::release, s.reverse_head);
  speeds("reverse_tail", Phase::release, s.reverse_tail);
  const auto of_law = [&law](std::string_view key) {
    std::string readers;
    for (const Law* one : laws()) {
      if (one->table == key) {
        readers += (readers.empty() ? "\"" : " or \"") + std::string(one->name) + '"';
      }
    }
    return Acts{law.table == key, "only controller.law = " + readers + " reads it"}(key);
  };
  io.table(of_law("knot_speed"), [&s](Io& table) {
    table.number("target", s.knot_speed.target, not_negative(cgs::speed));
    table.number("gain", s.knot_speed.gain, not_negative());
    table.number("filter", s.knot_speed.filter, not_negative());
    table.number("most", s.knot_speed.most, positive());
  });
  io.table(of_law("reduced_basis"),
           [&s](Io& table) { reduced_basis_fields(table, s.reduced_basis); });
  io.table(of_law("reflex"), [&s](Io& table) { reflex_fields(table, s.reflex); });
}

template <class Io>
void food_fields(Io& io, FoodSettings& s) {
  io.number("hold", s.hold, not_negative());
  const Acts food{s.hold != 0, "food.hold is 0: there is no food"};
  io.number(food("strength"), s.strength, positive());
  io.number(food("average"), s.average, positive());
  io.table(food("cap"), [&s](Io& table) {
    table.number("from", s.cap.from, not_negative(cgs::dyn));
    table.number("to", s.cap.to, not_negative(cgs::dyn));
    table.number("time", s.cap.time, not_negative());
  });
}

template <class Io>
void knot_fields(Io& io, KnotSettings& s) {
  io.integer("votes", s.votes, within(1, 10000));
  io.integer("seed", s.seed, any_number());
  io.number("interval", s.interval, positive());
}

template <class Io>
void time_fields(Io& io, TimeSettings& s) {
  io.template choice<TimeRule>("rule", s.rule,
                               {{"euler", TimeRule::euler}, {"midpoint", TimeRule::midpoint}});
  io.template choice<FreeMomentum>("momentum", s.momentum,
                                   {{"kept", FreeMomentum::kept}, {"rule", FreeMomentum::rule}});
  io.number("step", s.step, positive());
  const Acts midpoint{s.rule == TimeRule::midpoint, "only time.rule = \"midpoint\" reads it"};
  io.number(midpoint("settled"), s.settled, positive());
  io.integer(midpoint("passes"), s.passes, within(1, 1000));
  io.number(midpoint("ring_damping"), s.ring_damping, not_negative());
  io.number("frame_interval", s.frame_interval, positive());
  io.number("duration", s.duration, positive());
  io.choice("until", s.until, phases_from(Phase::form, true));
}

template <class Io>
void guard_fields(Io& io, GuardSettings& s) {
  io.template choice<GuardAction>("action", s.action,
                                  {{"stop", GuardAction::stop}, {"warn", GuardAction::warn}});
  io.number("penetration", s.penetration, positive(cgs::cm));
  io.angle("limit_violation", s.limit_violation, positive());
  io.number("speed", s.speed, positive(cgs::speed));
  io.number("energy_gain", s.energy_gain, not_negative());
  io.template choice<EnergyAction>(
      "energy_action", s.energy_action,
      {{"hold", EnergyAction::hold}, {"warn", EnergyAction::warn}, {"stop", EnergyAction::stop}});
  io.number("capped_time", s.capped_time, not_negative());
}

template <class Io>
void expect_fields(Io& io, const Acts& flesh, ExpectSettings& s) {
  io.string("knot", s.knot);
  const auto text = [](const RunTime& time) { return run_time_text(time); };
  // What is no time becomes none, which the reader refuses.
  const auto time = [](const std::string& called) {
    return run_time_called(called).value_or(RunTime{std::nullopt, NAN});
  };
  std::vector<std::array<std::string, 3>> stretches;
  for (const KnotStretch& k : s.types) stretches.push_back({k.type, text(k.from), text(k.to)});
  io.text_rows("types", "stretch", "[type, from, to]", stretches);
  s.types.clear();
  for (const auto& [type, from, to] : stretches) s.types.push_back({type, time(from), time(to)});
  io.template choice<Hand>("hand", s.hand,
                           {{"any", Hand::any}, {"right", Hand::right}, {"left", Hand::left}});
  io.length("slide_distance", s.slide_distance, not_negative());
  io.number("slide_share", s.slide_share, within(0, 1));
  io.length("reverse_distance", s.reverse_distance, not_negative());
  io.string("out_of", s.out_of);
  io.number("torque_share", s.torque_share, not_negative());
  io.number("pull", s.pull, not_negative());
  io.number("pull_settled", s.pull_settled, not_negative());
  io.number("pull_drift", s.pull_drift, not_negative());
  io.number("pull_balance", s.pull_balance, not_negative());
  io.number("speed_share", s.speed_share, within(0, 1));
  const Acts hard{!flesh.here, "flesh may overlap: expect.overlap bounds it"};
  io.number(hard("penetration"), s.penetration, not_negative(cgs::cm));
  io.number(flesh("overlap"), s.overlap, not_negative(cgs::cm));
  io.number("skin_fold", s.skin_fold, not_negative());
  io.angle("limit_violation", s.limit_violation, not_negative());
  io.number("head_drift", s.head_drift, not_negative(cgs::cm));
  io.number("kkt", s.kkt, not_negative());
  io.number("energy", s.energy, not_negative());
  io.number("energy_gain", s.energy_gain, not_negative());
  io.number("energy_loss", s.energy_loss, not_negative());
  io.number("momentum", s.momentum, not_negative());
}

/// Keys of a scene but `specimen`, which is a file name or a table.
template <class Io>
void scene_fields(Io& io, Scene& s, ScriptFile& script, std::vector<ObstacleFile>& obstacles) {
  io.string("title", s.title);
  io.boolean("mirror", s.mirror);
  io.boolean("clamp_head", s.clamp_head);
  io.vector("gravity", s.gravity, cgs::acceleration);
  io.table("model", [&](Io& t) { model_fields(t, s.model); });
  io.table("drag", [&](Io& t) {
    t.number("normal", s.drag.normal, not_negative(cgs::drag));
    t.number("tangential", s.drag.tangential, not_negative(cgs::drag));
  });
  io.table("constraints", [&](Io& t) { constraint_fields(t, s.constraints); });
  io.table("contact", [&](Io& t) {
    t.number("margin", s.contact.margin, not_negative(cgs::cm));
    t.length("least_arc", s.contact.least_arc, positive());
  });
  const auto flesh = [&s] {
    return Acts{s.flesh.present(), "flesh.stiffness is 0: contact is hard"};
  };
  io.table("flesh", [&](Io& t) {
    t.number("stiffness", s.flesh.stiffness, not_negative(cgs::stress));
    t.number(flesh()("relaxation"), s.flesh.relaxation, not_negative());
    t.number(flesh()("spacing"), s.flesh.spacing, not_negative(cgs::cm));
  });
  io.table("wall", [&](Io& t) {
    t.boolean("present", s.wall.present);
    t.length(Acts{s.wall.present, "wall.present is false"}("neck"), s.wall.neck, not_negative());
  });
  io.tables("obstacle", obstacles, [](Io& t, ObstacleFile& one) { obstacle_fields(t, one); });
  io.table("start", [&](Io& t) { start_fields(t, s.start); });
  io.table(Acts{.until = Phase::form}("script"), [&](Io& t) { script_fields(t, script); });
  io.table("active", [&](Io& t) { active_fields(t, s); });
  io.table("muscle", [&](Io& t) { muscle_fields(t, s); });
  io.table("controller", [&](Io& t) { controller_fields(t, s); });
  io.table(Acts{.until = Phase::pull}("food"), [&](Io& t) { food_fields(t, s.food); });
  io.table("knot", [&](Io& t) { knot_fields(t, s.knot); });
  io.table("time", [&](Io& t) { time_fields(t, s.time); });
  io.table("guard", [&](Io& t) { guard_fields(t, s.guard); });
  io.table("expect", [&](Io& t) { expect_fields(t, flesh(), s.expect); });
}

}  // namespace hagfish
