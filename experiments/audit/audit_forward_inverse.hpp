// The part of an audit that is made by MuJoCo: its step under the logged forces.
#pragma once

#include "experiments/audit/audit.hpp"

namespace hagfish {

/// Each frame's forces put back as applied forces in the log's own MuJoCo model, with its contacts
/// and limits off: one step must end at the logged q̇. Drag is the core's, at the end of the step.
/// Throws FileError where the log's model is not its scene's. Not judged, and so said, where the
/// program is built without MuJoCo.
Finding audit_forward_inverse(const LogContents& log);

}  // namespace hagfish
