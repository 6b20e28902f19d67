#include "experiments/common/idle_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <span>

#include "core/control/laws.hpp"
#include "core/input/input_error.hpp"

namespace hagfish {
namespace {

/// A key, or all keys of a table, and when nothing reads it.
struct IdleKey {
  std::string key;
  std::function<bool(const Scene&)> idle;
  const char* why;
};

bool has_law(const Scene& scene, std::initializer_list<const char*> names) {
  return std::ranges::find(names, scene.controller.law) != names.end();
}

bool has_script(const Scene& scene, ScriptSettings::Kind kind) { return scene.script.kind == kind; }

/// Whether the law asks for no rows of Eq. 6.
bool ignores_speeds(const Scene& scene) { return !law_of(scene).asks_for_eq6; }

const std::vector<IdleKey>& idle_keys() {
  using Kind = ScriptSettings::Kind;
  const auto no_reflex = [](const Scene& s) { return !has_law(s, {"reflex", "reflex_muscles"}); };
  const auto tail = [](const Scene& s) { return s.controller.leave_by != BodyEnd::tail; };
  const auto no_food = [](const Scene& s) { return s.food.hold == 0; };
  const auto euler = [](const Scene& s) { return s.time.rule != TimeRule::midpoint; };
  const auto no_script = [](const Scene& s) { return has_script(s, Kind::none); };
  const auto no_program = [](const Scene& s) { return !has_script(s, Kind::curvature); };
  const auto own_shape = [](const Scene& s) { return has_script(s, Kind::curvature); };
  const auto nothing_active = [](const Scene& s) {
    return !has_script(s, Kind::curvature) && has_law(s, {"paper", "all_contacts", "knot_speed"});
  };
  const auto no_spring = [](const Scene& s) { return !has_script(s, Kind::position); };
  const auto hard = [](const Scene& s) { return !s.flesh.present(); };
  const char* const no_flesh = "flesh.stiffness is 0: contact is hard";
  const char* const no_rows = "controller.law asks for no speeds of Eq. 6";
  const char* const of_midpoint = "only time.rule = \"midpoint\" reads it";
  const char* const of_curvature = "only script.kind = \"curvature\" reads it";
  const char* const of_active =
      "no torque is active: script.kind is not \"curvature\", and controller.law asks for none";
  const char* const of_position = "only script.kind = \"position\" reads it";
  const char* const of_animal = "model.passive = \"specimen\": the animal's own values are used";
  const auto own_passive = [](const Scene& s) {
    return s.model.passive == PassiveSource::specimen;
  };
  static const std::vector<IdleKey> keys = {
      {"start.seed", [](const Scene& s) { return s.start.noise == 0; }, "start.noise_deg is 0"},
      {"script.noise_seed", [](const Scene& s) { return s.script.noise == 0; },
       "script.noise is 0"},
      {"script.knots", no_script, "script.kind is \"none\": there is no script"},
      {"script.noise", no_script, "script.kind is \"none\": there is no script"},
      {"script.knots", own_shape, "script.kind = \"curvature\" reads script.program"},
      {"script.program", no_program, of_curvature},
      {"script.curvature", no_program, of_curvature},
      {"script.spring", no_spring, of_position},
      {"script.damper", no_spring, of_position},
      {"script.largest_force", no_spring, of_position},
      {"model.bending_stiffness", own_passive, of_animal},
      {"model.bending_damping", own_passive, of_animal},
      {"model.twist_stiffness", own_passive, of_animal},
      {"model.twist_damping", own_passive, of_animal},
      {"active.stiffness", nothing_active, of_active},
      {"active.tone_time", nothing_active, of_active},
      {"active.relax_time", nothing_active, of_active},
      {"constraints.corrections",
       [](const Scene& s) { return s.constraints.activation == Activation::violated; },
       "constraints.activation = \"violated\" corrects no step"},
      {"flesh.relaxation", hard, no_flesh},
      {"flesh.spacing", hard, no_flesh},
      {"expect.overlap", hard, no_flesh},
      {"expect.penetration", [](const Scene& s) { return s.flesh.present(); },
       "flesh may overlap: expect.overlap bounds it"},
      {"wall.neck", [](const Scene& s) { return !s.wall.present; }, "wall.present is false"},
      {"muscle.activation_time",
       [](const Scene& s) {
         return !has_law(s, {"muscles", "reflex_muscles", "own"});
       },
       "controller.law drives no muscles"},
      {"controller.slide_head", ignores_speeds, no_rows},
      {"controller.slide_tail", ignores_speeds, no_rows},
      {"controller.tighten_head", ignores_speeds, no_rows},
      {"controller.tighten_tail", ignores_speeds, no_rows},
      {"controller.eq6_at", ignores_speeds, no_rows},
      {"controller.eq6_slip", ignores_speeds, no_rows},
      {"controller.cap", ignores_speeds, no_rows},
      {"controller.free_from", [](const Scene& s) { return !s.clamp_head; },
       "clamp_head is false: the head is never held"},
      {"controller.reverse_head", tail,
       "controller.leave_by is \"head\": there is no slide to the tail"},
      {"controller.reverse_tail", tail,
       "controller.leave_by is \"head\": there is no slide to the tail"},
      {"controller.knot_speed", [](const Scene& s) { return !has_law(s, {"knot_speed"}); },
       "only controller.law = \"knot_speed\" reads it"},
      {"controller.reduced_basis", [](const Scene& s) { return !has_law(s, {"reduced_basis"}); },
       "only controller.law = \"reduced_basis\" reads it"},
      {"controller.reflex.seed", [](const Scene& s) { return s.controller.reflex.noise == 0; },
       "controller.reflex.noise is 0"},
      {"controller.reflex", no_reflex, "only laws \"reflex\" and \"reflex_muscles\" read it"},
      {"food.strength", no_food, "food.hold is 0: there is no food"},
      {"food.average", no_food, "food.hold is 0: there is no food"},
      {"food.cap", no_food, "food.hold is 0: there is no food"},
      {"time.settled", euler, of_midpoint},
      {"time.passes", euler, of_midpoint},
      {"time.ring_damping", euler, of_midpoint},
  };
  return keys;
}

/// What only a run's start reads, or phases up to one that is over.
struct PastKey {
  const char* key;
  Phase last;  ///< in which it acts
};
constexpr PastKey past_keys[] = {{"script", Phase::form},
                                 {"controller.tail_through", Phase::form},
                                 {"controller.tighten_from", Phase::form},
                                 {"controller.tighten_head", Phase::tighten},
                                 {"controller.tighten_tail", Phase::tighten},
                                 {"controller.tighten_time", Phase::tighten},
                                 {"controller.tight_span", Phase::tighten},
                                 {"controller.tight_hold", Phase::tighten},
                                 {"food", Phase::pull},
                                 {"controller.slide_head", Phase::release},
                                 {"controller.slide_tail", Phase::release},
                                 {"controller.reverse_head", Phase::release},
                                 {"controller.reverse_tail", Phase::release}};

/// The keys of KEY=VALUE texts.
std::vector<std::string> keys_of(const std::vector<std::string>& set) {
  std::vector<std::string> keys;
  for (const std::string& one : set) {
    std::string key = one.substr(0, one.find('='));
    std::erase(key, ' ');
    keys.push_back(key);
  }
  return keys;
}

/// Whether `key` is `of` or within it.
bool concerns(const std::string& key, const std::string& of) {
  return key == of || key.starts_with(of + ".");
}

/// Why nothing reads `key` in any of `scenes`; null where something may. One reason must hold in
/// all of them: two scenes may each lack one of two things that the key needs, and a third have
/// both.
const char* why_idle(std::span<const Scene> scenes, const std::string& key) {
  const auto& keys = idle_keys();
  const auto found = std::ranges::find_if(keys, [&](const IdleKey& one) {
    return concerns(key, one.key) && std::ranges::all_of(scenes, one.idle);
  });
  return found == keys.end() ? nullptr : found->why;
}

}  // namespace

void require_settings_act(const Scene& scene, const std::vector<std::string>& set) {
  for (const std::string& key : keys_of(set)) {
    if (const char* why = why_idle({&scene, 1}, key)) {
      throw InputError(fmt::format("--set {}: has no effect here: {}", key, why));
    }
  }
}

void require_settings_act_somewhere(const std::vector<Scene>& scenes,
                                    const std::vector<std::string>& set) {
  for (const std::string& key : keys_of(set)) {
    if (const char* why = why_idle(scenes, key)) {
      throw InputError(fmt::format("{}: has no effect in any cell: {}", key, why));
    }
  }
}

void require_settings_act_from(const Simulation& sim, const Scene& scene,
                               const std::vector<std::string>& set) {
  require_settings_act(scene, set);
  const Phase now = sim.controller.phase;
  for (const std::string& key : keys_of(set)) {
    if (concerns(key, "start")) {
      throw InputError(
          fmt::format("--set {}: has no effect here: the branch begins where its log stands", key));
    }
    for (const PastKey& one : past_keys) {
      if (concerns(key, one.key) && phase_order(now) > phase_order(one.last)) {
        throw InputError(fmt::format("--set {}: has no effect here: the branch begins in phase {}",
                                     key, phase_name(now)));
      }
    }
  }
}

}  // namespace hagfish
