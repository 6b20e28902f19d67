// The controller (paper, 3.2): forms the knot by a script, then tightens and slides it by positive
// thigmotaxis, then releases the head. It switches phases by knot type and knot span alone. A
// control law decides what is done in each phase (control_law.hpp).
#pragma once

#include <cmath>
#include <optional>

#include "core/control/laws.hpp"
#include "core/control/script.hpp"
#include "core/knot/knot.hpp"
#include "core/muscle/active_curvature.hpp"
#include "core/scene/phase.hpp"
#include "core/step/outcome.hpp"
#include "core/step/step_solution.hpp"

namespace hagfish {

/// The last knot that came undone: its type, and between which times it was seen, s.
struct PastKnot {
  KnotInvariants type;
  double from = 0, to = 0;
};

/// The pull at the food since its mean was last taken.
struct PullSum {
  double sum = 0;  ///< sum of the steps' pulls, dyn
  int steps = 0;
};

struct ControllerState {
  Phase phase = Phase::form;
  double phase_start = 0;        ///< s
  double loose = 0;              ///< time at which the knot last spanned more than tight_span, s
  KnotVote knot;                 ///< knot as last seen
  double knot_seen = -INFINITY;  ///< time at which it was seen, s
  double knot_from = 0;          ///< time since when it is of that type, s
  PastKnot past;                 ///< the last knot before it; an unknot where there was none
  std::string lost;   ///< how the knot was lost, in scenes that only warn; empty before that
  TouchingEnds ends;  ///< the knot's first and last contact
  PullSum pull;
  Eigen::VectorXd rest_shape;  ///< rest shape as last commanded (Control), nv or empty
  Eigen::VectorXd memory;      ///< memory of the control law
};

/// Extent of the knot: TouchingEnds::head_end and tail_end, cm of arc.
struct KnotSpan {
  double head_end = 0, tail_end = 0;
};
std::optional<KnotSpan> knot_span(const ControllerState& controller);

/// Whether the head is clamped in a phase.
bool clamps_head(const Scene& scene, Phase phase);

/// The force by which the head pulls at its clamp, along +x away from it, dyn, from the generalised
/// force of the head clamp (nv).
inline double pull_of(const Eigen::VectorXd& head) { return -head[0]; }

/// Adds the pull of a solved step while the knot pulls.
void note_pull(const StepSolution& step, ControllerState& controller);

/// Follows the contacts and switches phases at the start of the step from `time`. The status is
/// never_tied if the script ends without the scene's knot, or with too little tail through it. It
/// is knot_lost if the knot comes undone too early, unless the scene only warns. The message names
/// the knot that is there, and since when.
Status follow(const Model& model, const Scene& scene, const ObservedState& now, double time,
              ControllerState& controller);

/// Decides the control of that step, by `own` law or, without one, by the law that the scene names.
/// Throws what the law throws, and std::invalid_argument if the scene's law and `own` do not fit,
/// or if the control is invalid (check_control).
void command(const Model& model, const Scene& scene, const ObservedState& now, double time,
             const ControlLaw& own, NamedLaw& named, ControllerState& controller, Control& control);

/// Calls both functions in turn.
Status decide(const Model& model, const Scene& scene, const ObservedState& now, double time,
              NamedLaw& named, ControllerState& controller, Control& control,
              const ControlLaw& own = {});

}  // namespace hagfish
