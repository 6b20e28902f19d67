// The first stage of a design: a hand leads the tail of the animal with a soft body along a path,
// and the knot type is watched.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/chain/model.hpp"
#include "core/input/scene_reader.hpp"
#include "core/knot/knot.hpp"
#include "experiments/design/tail_path.hpp"

namespace hagfish {

/// An animal and the scene in which its tail is led: that of overhand_waypoints without a path.
struct SoftBody {
  ResolvedScene resolved;
  Model model;
};

/// `specimen`: text of the animal's file; empty: that of the built-in scenes. Throws InputError.
SoftBody soft_body(const std::string& specimen);

/// What a scene calls `knot`, a name of knot_table.hpp or invariants_text(): of what only full
/// names tell apart, the invariants. Nothing of any other text.
std::optional<std::string> name_in_scene(const std::string& knot);

/// A stretch of time in which the knot has one type.
struct TypeSeen {
  KnotInvariants type;
  double from = 0, to = 0;  ///< s
};

/// What a path tied.
struct Tying {
  std::vector<TypeSeen> seen;  ///< one after the other; the first is the unknot, from 0
  bool failed = false;         ///< a guard or the solver ended the run

  /// The type at the end of a run that did not fail, where it lasted a second.
  std::optional<KnotInvariants> tied() const;
};

/// Leads the tail along `path`, at steps of 20 ms. Nothing where `interrupted`.
std::optional<Tying> try_path(const SoftBody& body, const TailPath& path,
                              const std::function<bool()>& interrupted);

/// Shapes of a body while it is knotted and pulled together.
struct Shapes {
  std::vector<double> time;  ///< s, from 0
  Eigen::MatrixXd q;         ///< a row each
  double tighten_from = 0;   ///< s
  std::string failure;       ///< why there are no shapes up to the end, or empty
};

/// The same at steps of 10 ms, and the knot, which must be `wanted` (a name of knot_table.hpp, or
/// invariants_text()), is then tightened for `tightening` (s).
Shapes tied_shapes(const SoftBody& body, const TailPath& path, const std::string& wanted,
                   double tightening);

}  // namespace hagfish
