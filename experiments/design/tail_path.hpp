// Ways of the tail in space, as the search makes them: the tail swings over to the body, winds
// about strands of it, and is pulled away.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/scene/settings.hpp"
#include "experiments/design/draw.hpp"

namespace hagfish {

struct Reached;  // soft_body.hpp

/// Waypoints of the last body's centre, for a script of kind position.
struct TailPath {
  struct Waypoint {
    double time = 0;        ///< s, rising; the first at 0
    Eigen::Vector3d place;  ///< body lengths; the head at the origin, the straight body along +x
  };
  std::vector<Waypoint> swing, turns, pull;  ///< one after the other
};

/// The next waypoint, on about a strand of the body, which is known once the body is there; or off
/// it, which tightens what is tied and leaves more of the tail.
struct Winding {
  double choice = 0;    ///< 0 to 1: which strand within reach; negative: that of the turn before
  double angle = 0;     ///< turn about the strand, from the waypoint before, rad
  double along = 0;     ///< way along the strand, from the waypoint before, body lengths
  double radius = 0;    ///< distance from the strand's middle, body lengths
  double duration = 0;  ///< s; more where the tail would have to hurry
  double off = 0;       ///< distance off the body in place of a turn, body lengths; 0: a turn
  Eigen::Vector3d aside = Eigen::Vector3d::Zero();  ///< added to the unit vector off the body
};

/// A path, and how it goes on from its end.
struct PathPlan {
  TailPath path;
  std::vector<Winding> turns;
  std::shared_ptr<const Reached> reached{};  ///< state that the path reached, to go on from
  int parent = -1;                           ///< number of the try whose path this was, or none
};

/// A swing over and 5 to 16 turns: nothing is known of any knot. Half of the plans turn about
/// strands where they then lie, half about lines where strands lie before anything moves.
PathPlan random_plan(Draw& draw);

/// A plan that goes on from the end of `path` by 1 to 8 turns; a third of the plans leads the tail
/// off the body first.
PathPlan further_plan(const TailPath& path, Draw& draw);

/// `path` with its waypoints displaced, or another pull where it ends with one, or both.
TailPath displaced_path(const TailPath& path, Draw& draw);

/// Adds the next waypoint. `centre`: of the bodies, 3 x n, body lengths. `strand` is the body
/// that the turn before was about, and becomes that of this one. Does nothing where the path has as
/// many turns as a tail can make.
void add_turn(TailPath& path, const Winding& turn, const Eigen::Matrix3Xd& centre, int& strand);

/// Takes away what lies behind `time` (s) and pulls the tail on, more or less to where it points.
/// `centre`: as above, at that time.
void end_with_pull(TailPath& path, double time, const Eigen::Matrix3Xd& centre, Draw& draw);

/// The path up to that many waypoints behind `time` (s), without a pull.
TailPath path_with_ahead(const TailPath& path, double time, int ahead);

/// Number of waypoints of swing and turns behind `time` (s).
int waypoints_after(const TailPath& path, double time);

/// The script's knots for an animal of that length, cm.
std::vector<Waypoint> waypoints_of(const TailPath& path, double length);

double path_end(const TailPath& path);  ///< s

}  // namespace hagfish
