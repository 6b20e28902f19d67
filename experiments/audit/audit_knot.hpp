// The part of an audit that is about the knot: its type through time, its hand, how it slid.
#pragma once

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

/// Findings against the scene's [expect]; none where the scene expects no knot. What a run that
/// stops early (time.until) does not reach is not judged.
std::vector<Finding> audit_knot(const LogContents& log, const std::vector<SeenKnot>& seen);

}  // namespace hagfish
