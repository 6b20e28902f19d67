// A process of its own for what may crash.
#pragma once

#include <functional>

namespace hagfish {

/// Whether an argument names an HDF5 file, on which HDF5 may crash or come to no end.
bool reads_hdf5(int argc, char** argv);

/// Returns what `work` returns, in a process of its own that ends with this one. Signals to this
/// one are passed on. Where a library crashes there, or comes to no end, tells it in one line and
/// returns exit_code::bad_input.
int in_own_process(const std::function<int()>& work, int argc, char** argv);

}  // namespace hagfish
