// Ways of the tail in space, as the search makes them: the tail swings over to the body, winds
// about strands of it, and is pulled away.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scene/settings.hpp"
#include "experiments/design/draw.hpp"

namespace hagfish {

/// Waypoints of the last body's centre, for a script of kind position.
struct TailPath {
  struct Waypoint {
    double time = 0;        ///< s, rising; the first at 0
    Eigen::Vector3d place;  ///< body lengths; the head at the origin, the straight body along +x
  };
  std::vector<Waypoint> swing, turns, pull;  ///< one after the other
};

/// A swing over, 5 to 16 waypoints about strands, and a pull: nothing is known of any knot.
TailPath random_path(Draw& draw);

/// A path like `parent`: its turns displaced, or more or fewer of them, or another end.
TailPath mutated_path(const TailPath& parent, Draw& draw);

/// The path up to `time` (s), then pulled away.
TailPath shortened_path(const TailPath& path, double time, Draw& draw);

/// The script's knots for an animal of that length, cm.
std::vector<ScriptKnot> script_knots(const TailPath& path, double length);

double path_end(const TailPath& path);  ///< s

}  // namespace hagfish
