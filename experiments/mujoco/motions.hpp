// Smooth motions of the chain alone, for studies of the time step: no contacts, limits or drag.
#pragma once

#include <array>
#include <string_view>

#include "core/chain/model.hpp"
#include "core/chain/state.hpp"

namespace hagfish {

/// Start of a motion: straight and at rest but for its hinges.
struct Motion {
  /// A hinge's angle, rad, and rate, rad/s.
  struct Bend {
    double angle = 0;
    double rate = 0;
  };
  std::string_view name;
  std::string_view title;
  double gravity = 0;  ///< gravity along the straight body, from head to tail, cm/s^2
  /// Bend about Y at `station` (0 head to 1 tail) of a hinge that stands for `arc` cm of body.
  Bend (*bend)(double station, double arc) = nullptr;
};

/// A coil that opens; a hanging chain that swings; a body whose front starts to turn and flings
/// the rest round.
extern const std::array<Motion, 3> motions;

/// The motion's first state. Bends about X and Z are shares of that about Y, so that it leaves the
/// plane.
State start_of(const Motion& motion, const Model& model);

}  // namespace hagfish
