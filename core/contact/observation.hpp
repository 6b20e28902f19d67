// All that is derived from a state: kinematics, contacts and violations of constraints.
#pragma once

#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"
#include "core/chain/state.hpp"
#include "core/contact/contact.hpp"
#include "core/contact/ends.hpp"
#include "core/contact/flesh.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// Computed once for each state; used by controller, constraints and log.
struct Observation {
  Kinematics kin;
  std::vector<SplineSegment> segments;  ///< segments of the body and of obstacles (obstacles.hpp)
  ContactSet contact;
  TouchingEnds ends;           ///< ends of the body's contact with itself
  EndPatches patches;          ///< patches that begin there
  Flesh flesh;                 ///< empty where contact is hard
  double penetration = 0;      ///< deepest overlap of skins or with an obstacle, cm, >= 0
  double limit_violation = 0;  ///< largest angle past a limit, rad, >= 0
};

/// A state and its observation.
struct ObservedState {
  State state;
  Observation observation;
};

/// Writes what follows from `state` into `observation`; `search` passes the candidate pairs from
/// one state to the next.
void observe(const Model& model, const State& state, const Scene& scene, ContactSearch& search,
             Observation& observation);
Observation observe(const Model& model, const State& state, const Scene& scene);
/// Observes a state whose positions are in observation.kin already.
void observe_placed(const Model& model, const State& state, const Scene& scene,
                    ContactSearch& search, Observation& observation);

/// Largest displacement of the head from its clamped pose, cm. It is taken at both ends and at its
/// side, which shows a rotation about its own axis.
double head_drift(const Model& model, const Kinematics& kin);

}  // namespace hagfish
