// The part of an audit that is about the knot: its type through time, its hand, how it slid.
#pragma once

#include <optional>
#include <vector>

#include "core/knot/knot.hpp"
#include "experiments/audit/audit.hpp"
#include "experiments/audit/audited_frame.hpp"

namespace hagfish {

/// The knot of one frame, from the body as its q says.
struct SeenKnot {
  KnotVote vote;
  double writhe = 0;  ///< while the knot is held, else 0
};
SeenKnot see_knot(const LogContents& log, const AuditedFrame& frame);

/// Where an end of the knot is at the first and last frame of a phase that show it, cm of arc.
struct KnotWay {
  double first = 0, last = 0;
  bool whole = true;  ///< the log has the phase from its beginning, as a branch need not have
};
/// The slide of a knot's head end in `scene`, against what is asked of it: the scene's distance,
/// or, where the knot was nearer to where it is released, all the way there, but half of that
/// distance at least where the whole slide is seen. And the way back of its tail end. Nothing found
/// is never met.
Criterion slide_found(const Scene& scene, const std::optional<KnotWay>& head_end);
Criterion reverse_found(const Scene& scene, const std::optional<KnotWay>& tail_end);

/// Findings against the scene's [expect]; none where the scene expects no knot. What a run that
/// stops early (time.until) does not reach is not judged.
std::vector<Finding> audit_knot(const LogContents& log, const std::vector<SeenKnot>& seen);

}  // namespace hagfish
