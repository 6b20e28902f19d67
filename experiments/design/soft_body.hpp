// The first stage of a design: a hand leads the tail of the animal with a soft body along a path,
// and the knot type is watched.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/chain/model.hpp"
#include "core/input/files/scene_reader.hpp"
#include "core/knot/knot.hpp"
#include "core/run/simulation.hpp"
#include "experiments/design/tail_path.hpp"

namespace hagfish {

/// An animal and the scene in which its tail is led: that of overhand_waypoints without a path.
using SoftBody = ResolvedScene;

/// `specimen`: text of the animal's file; empty: that of the built-in scenes. Throws InputError.
SoftBody soft_body(const std::string& specimen);

/// What a scene calls `knot`, a name of knot_table.hpp or invariants_text(): of what only full
/// names tell apart, the invariants. Nothing of any other text.
std::optional<std::string> name_in_scene(const std::string& knot);

struct Reached;

/// A stretch of time in which the knot has one type.
struct TypeSeen {
  KnotInvariants type;
  double from = 0, to = 0;  ///< s
  double at = 0;    ///< s, the look from which other tries go on: with two waypoints ahead and most
                    ///< of the tail left; 0: none
  double left = 0;  ///< share of the body left then: see tail_left()
  bool repeats = false;  ///< the living body ties it, too, by the shapes up to then: see repeats()
  std::shared_ptr<const Reached> reached{};  ///< state reached then
};

/// A try on its way, from which others go on as if they had come all the way.
struct Reached {
  Simulation sim;
  TailPath path;  ///< path with the two waypoints ahead
  std::vector<TypeSeen> seen;
};

/// Part of the path that a try has taken: up to the two waypoints that were ahead of TypeSeen::at.
TailPath path_reached(const TailPath& path, double at);

/// The share of the body that can be cut off behind without another type: what is left of the tail
/// to go on with. `centre`: of the bodies, 3 x n, any length unit.
double tail_left(const Eigen::Matrix3Xd& centre, const KnotInvariants& type,
                 const KnotSettings& settings);

/// What a path tied.
struct Tying {
  std::vector<TypeSeen> seen;  ///< one after the other; the first is the unknot, from 0
  bool failed = false;         ///< a guard or the solver ended the run
  TailPath path;               ///< path that was taken; with a pull if the wanted type was seen

  /// The type at the end of a run that did not fail and ended with a pull, where it lasted a
  /// second.
  std::optional<KnotInvariants> tied() const;
};

/// Leads the tail as planned, at steps of 20 ms. As soon as `wanted` (as of tied_shapes) has been
/// seen at two looks, and is what its full name says, the path ends with a pull, drawn by `draw`.
/// What is found does not depend on whether the plan has where its path has led already
/// (PathPlan::reached). Nothing where `interrupted`.
std::optional<Tying> try_plan(const SoftBody& body, const PathPlan& plan, const std::string& wanted,
                              Draw& draw, const std::function<bool()>& interrupted);

/// Shapes of a body while it is knotted.
struct Shapes {
  std::vector<double> time;  ///< s, from 0
  Eigen::MatrixXd q;         ///< a row each
  std::string failure;       ///< why there are no shapes up to the end, or empty
};

/// The path again, up to `until` (s).
Shapes led_shapes(const SoftBody& body, const TailPath& path, double until);

/// The path again, up to a knot with enough tail behind it, which must be `wanted` (a name of
/// knot_table.hpp, or invariants_text()). It is not tightened: a stiff body's knot that is grows
/// instead of sliding.
Shapes tied_shapes(const SoftBody& body, const TailPath& path, const std::string& wanted);

}  // namespace hagfish
