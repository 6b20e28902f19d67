// The part of an audit that needs MuJoCo: do the logged forces make the logged motion there too?
#pragma once

#include "experiments/audit/audit.hpp"

namespace hagfish {

/// Each frame's forces put back as applied forces in the log's own MuJoCo model, with its contacts
/// and limits off: one step must end at the logged q̇. Drag is the core's, at the end of the step.
/// Throws FileError where /mjcf is not the scene's model. Not judged, and so told, where the
/// program is built without MuJoCo.
Finding audit_forward_inverse(const LogContents& log);

}  // namespace hagfish
