// A film strip of a log: frames side by side.
#pragma once

#include <vector>

#include "core/log/reading/log_contents.hpp"
#include "experiments/mujoco/frame_picture.hpp"

namespace hagfish {

/// The frames nearest to `times` (s), left to right, through one window of `size` each. The log has
/// its frames. Throws InputError for a time outside of it, or for none.
Image strip_of(const LogContents& log, const std::vector<double>& times, PictureSize size);

}  // namespace hagfish
