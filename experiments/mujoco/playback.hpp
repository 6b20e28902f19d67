// The slide of a log in MuJoCo under f_thigmo alone, the log's mean from frame to frame.
#pragma once

#include "core/log/hdf5/hdf5_writer.hpp"
#include "core/log/reading/log_contents.hpp"

namespace hagfish {

/// Prints a table and leaves what it is made of in `h5`. Throws FileError where the knot of the log
/// does not slide for two frames, or where intervals between restarts are no whole frames.
void playback(const LogContents& log, Hdf5Writer& h5);

}  // namespace hagfish
