#include "core/control/reflex.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>

#include "core/control/controller.hpp"
#include "core/muscle/active_curvature.hpp"
#include "core/scene/normal_draw.hpp"

namespace hagfish {
namespace {

double arc_of(const Model& model, int k) {
  return model.length() * model.hinges[k].body / model.body_count();
}

/// Length of body that a hinge stands for, cm.
double span_of(const Model& model, int k) { return hinge_span(model, model.hinges[k].body); }

/// The next hinge of the same kind, tailward (`way` 1) or headward (-1); -1 if there is none.
int neighbour(const Model& model, int k, int way) {
  for (int i = k + way; i >= 0 && i < model.hinge_count(); i += way) {
    if (model.hinges[i].axis == model.hinges[k].axis) return i;
  }
  return -1;
}

/// Distance from a hinge to the next one of its kind, cm. Without a next one, that of alternating
/// joints.
double spacing(const Model& model, int k, int way) {
  const int next = neighbour(model, k, way);
  const int bodies = next < 0 ? 2 : std::abs(model.hinges[next].body - model.hinges[k].body);
  return bodies * model.bodies[model.hinges[k].body].length;
}

/// Whether the scene lets a hinge copy, given the `contacts` of the body with itself.
bool copies(const Model& model, const ControllerSettings& controller, const ContactSet& contacts,
            int k) {
  const ReflexSettings& reflex = controller.reflex;
  const Axis axis = model.hinges[k].axis;
  if (!(axis == Axis::x ? reflex.twist : axis == Axis::y ? reflex.bend_y : reflex.bend_z)) {
    return false;
  }
  const double arc = arc_of(model, k);
  return reflex.gate == ReflexGate::all ||
         std::ranges::any_of(contacts.contacts, [&](const Contact& c) {
           return c.gap <= controller.contact_gap &&
                  std::min(std::abs(c.arc_a - arc), std::abs(c.arc_b - arc)) <= reflex.reach;
         });
}

/// Angles of the hinges when the forces of a step act, rad.
void look_ahead(const Scene& scene, const Eigen::VectorXd& q, const Eigen::VectorXd& qdot,
                Eigen::VectorXd& own) {
  const Eigen::Index count = qdot.size() - root_dofs;
  own = q.tail(count) + scene.time.reach() * qdot.tail(count);
}

std::int64_t step_at(const Scene& scene, double time) {
  return std::llround(time / scene.time.step);
}

/// Each sensed angle has its own error, the same for the same seed and step.
void add_noise(const ReflexSettings& reflex, std::int64_t step, Eigen::VectorXd& sensed) {
  if (reflex.noise == 0) return;
  constexpr unsigned stride = 7919;  // so that no step repeats the draws of another seed's step
  std::mt19937 random(reflex.seed + stride * static_cast<unsigned>(step));
  for (double& angle : sensed) angle *= 1 + reflex.noise * normal_draw(random);
}

/// The angles of `lag` steps ago. `memory` begins with the sensed angles. Behind them is a ring of
/// `lag` rows, in which this step's row is the oldest one: it is sensed, and overwritten.
void sense_late(const Scene& scene, double time, const Eigen::VectorXd& q, Eigen::Index count,
                Eigen::VectorXd& memory, Eigen::VectorXd& sensed) {
  const int lag = reflex_lag(scene);
  const auto angles = q.tail(count);
  if (memory.size() == 0) memory = angles.replicate(lag + 1, 1);
  auto oldest = memory.segment((1 + step_at(scene, time) % lag) * count, count);
  sensed = oldest;
  memory.head(count) = sensed;
  oldest = angles;
}

/// q_ref of a phase in which joints copy.
void copy_neighbours(const Model& model, const Scene& scene, Phase phase,
                     const ContactSet& contacts, const Eigen::VectorXd& own,
                     const Eigen::VectorXd& sensed, Eigen::VectorXd& rest) {
  const double shift = reflex_shift(scene.controller.reflex, phase);
  rest.setZero(model.nv());
  rest.tail(own.size()) = own;
  for (int k = 0; k < own.size(); ++k) {
    if (copies(model, scene.controller, contacts, k)) {
      rest[root_dofs + k] += copied_angle(model, sensed, k, shift) - sensed[k];
    }
  }
}

}  // namespace

bool reflex_acts(Phase phase) {
  return phase_order(phase) > phase_order(Phase::form) &&
         phase_order(phase) < phase_order(Phase::release);
}

double reflex_shift(const ReflexSettings& reflex, Phase phase) {
  if (phase == Phase::reverse) return -reflex.shift;
  return phase == Phase::pull && reflex.pull_shift != 0 ? reflex.pull_shift : reflex.shift;
}

int reflex_lag(const Scene& scene) {
  return static_cast<int>(std::lround(scene.controller.reflex.delay / scene.time.step));
}

Eigen::Index reflex_memory_size(const Model& model, const Scene& scene) {
  const int lag = reflex_lag(scene);
  return lag == 0 ? 0 : (lag + 1) * model.hinge_count();
}

double copied_angle(const Model& model, const Eigen::VectorXd& angles, int k, double shift) {
  const int way = shift < 0 ? -1 : 1;
  const double arc = arc_of(model, k) + shift;
  for (int i = k; i >= 0;) {
    const int next = neighbour(model, i, way);
    const double from = arc_of(model, i);
    const double to = next < 0 ? from + way * spacing(model, i, -way) : arc_of(model, next);
    if (way * (to - arc) >= 0) {
      const double here = angles[i] / span_of(model, i);
      const double there = next < 0 ? 0 : angles[next] / span_of(model, next);
      return span_of(model, k) * std::fma((arc - from) / (to - from), there - here, here);
    }
    i = next;
  }
  return 0;
}

void reflex_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                ReflexStorage& storage) {
  const auto& [model, scene, now, time, so_far] = at;
  auto& [q, qdot] = now.state;
  paper_law(at, control);
  control.thigmotaxis.clear();
  if (!reflex_acts(so_far.phase)) {
    memory.resize(0);
    // Without a program there is no shape to form, and none to relax from.
    if (scene.script.kind != ScriptSettings::Kind::curvature) control.rest_shape.resize(0);
    return;
  }
  look_ahead(scene, q, qdot, storage.own);
  if (reflex_lag(scene) > 0) {
    sense_late(scene, time, q, model.hinge_count(), memory, storage.sensed);
  } else {
    storage.sensed = storage.own;
  }
  add_noise(scene.controller.reflex, step_at(scene, time), storage.sensed);
  copy_neighbours(model, scene, so_far.phase, now.observation.contact, storage.own, storage.sensed,
                  control.rest_shape);
}

namespace {

/// The sensed angles of the step, if they are delayed. Else the state gives them.
constexpr LawNumbers numbers[] = {
    {.path = "/reflex/sensed",
     .unit = "rad",
     .description = "angles of the hinges that the senses show, late, without their noise",
     .size = [](const Model& model, const Scene& scene) -> Eigen::Index {
       return reflex_lag(scene) > 0 ? model.hinge_count() : 0;
     },
     .of = [](const Eigen::VectorXd& memory,
              Eigen::Index size) { return Eigen::VectorXd(memory.head(size)); }}};

}  // namespace

extern constinit const Law reflex_record{
    .name = "reflex",
    .description = "every joint copies its tailward neighbour, without Eq. 6",
    .make = law_with_storage<ReflexStorage, reflex_law>,
    .memory_size = reflex_memory_size,
    .fault = reflex_fault,
    .numbers = numbers,
    .asks_for_eq6 = false,
    .bends = true,
    .table = "reflex"};

std::optional<SceneFault> reflex_fault(const Specimen& specimen, const Scene& scene) {
  const ReflexSettings& reflex = scene.controller.reflex;
  const std::string table = "controller.reflex.";
  const std::string where = " where controller.law = \"" + scene.controller.law + "\"";
  if (reflex.shift == 0) return SceneFault{table + "shift", "must not be 0" + where};
  for (const auto& [key, value] :
       {std::pair("shift", reflex.shift), {"pull_shift", reflex.pull_shift}}) {
    if (std::abs(value) >= specimen.length) {
      return SceneFault{table + key, "must be less than the animal's length"};
    }
  }
  if (!reflex.bend_y && !reflex.bend_z && !reflex.twist) {
    return SceneFault{table + "bend_y", "must be true, or bend_z or twist must be true"};
  }
  if (reflex.gate == ReflexGate::touch && reflex.reach == 0) {
    return SceneFault{table + "reach", "must be positive where gate = \"touch\""};
  }
  if (reflex.gate == ReflexGate::touch && scene.contact.least_arc >= specimen.length) {
    return SceneFault{table + "gate", "the body never touches itself (contact.least_arc)"};
  }
  if (reflex.delay > 0 && reflex.delay < scene.time.step) {
    return SceneFault{table + "delay", "must not be less than time.step"};
  }
  constexpr int most_lag = 10000;  // largest delay, in steps
  if (reflex.delay > most_lag * scene.time.step) {
    return SceneFault{table + "delay",
                      "must be at most " + std::to_string(most_lag) + " times time.step"};
  }
  for (const auto& [key, value] : {std::pair("active.stiffness", scene.active.stiffness),
                                   {"active.relax_time", scene.active.relax_time},
                                   {"active.capacity", scene.active.capacity}}) {
    if (value == 0) return SceneFault{key, "must be positive" + where};
  }
  return {};
}

}  // namespace hagfish
