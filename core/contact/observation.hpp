// What a state looks like: kinematics, contacts and how far constraints are violated.
#pragma once

#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"
#include "core/chain/state.hpp"
#include "core/contact/contact.hpp"
#include "core/contact/ends.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// Found once per state, used by controller, constraints and log.
struct Observation {
  Kinematics kin;
  std::vector<SplineSegment> segments;  ///< of the body and of obstacles (obstacles.hpp)
  ContactSet contact;
  TouchingEnds ends;           ///< of the body with itself
  double penetration = 0;      ///< deepest overlap of skins or with an obstacle, cm, >= 0
  double limit_violation = 0;  ///< largest angle past a limit, rad, >= 0
};

/// A state and what it looks like.
struct Moment {
  State state;
  Observation observation;
};

/// Observes `state` into the storage of `observation`; `search` carries the candidate pairs from
/// one state to the next.
void observe(const Model& model, const State& state, const Scene& scene, ContactSearch& search,
             Observation& observation);
Observation observe(const Model& model, const State& state, const Scene& scene);
/// The same where the positions in observation.kin are those of `state` already.
void observe_placed(const Model& model, const State& state, const Scene& scene,
                    ContactSearch& search, Observation& observation);

/// Largest displacement of the head from its clamped pose, cm: of either end and of its side, which
/// shows a turn about its own axis.
double head_drift(const Model& model, const Kinematics& kin);

}  // namespace hagfish
