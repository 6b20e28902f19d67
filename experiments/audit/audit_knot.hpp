// The part of an audit that is about the knot: its type through time, its hand, how it slid.
#pragma once

#include <functional>
#include <vector>

#include "core/knot/knot.hpp"
#include "core/run/slide.hpp"
#include "experiments/audit/audit.hpp"
#include "experiments/audit/audited_frame.hpp"

namespace hagfish {

/// The knot of one frame, from the body as its q says.
struct SeenKnot {
  KnotVote vote;
  double writhe = 0;  ///< while the knot is held and its hand is asked for, else 0
};
SeenKnot see_knot(const LogContents& log, const AuditedFrame& frame);

/// The slide and the way back of a log that has q. Calls `seen`, if any, after each frame, with
/// what there was up to it.
SlideWatch slides_of(const LogContents& log,
                     const std::function<void(const SlideWatch& so_far)>& seen = {});

/// Largest torque of a hinge while the knot slides or pulls, the animal's own and f_thigmo
/// together, mean from frame to frame, dyn cm.
double largest_muscle_torque(const LogContents& log);

/// Findings against the scene's [expect]; none where the scene expects no knot. What a run that
/// stops early (time.until) does not reach is not judged.
std::vector<Finding> audit_knot(const LogContents& log, const std::vector<SeenKnot>& seen);

}  // namespace hagfish
