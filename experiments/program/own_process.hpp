// A process of its own for what may crash.
#pragma once

#include <functional>
#include <string>

namespace hagfish {

/// The HDF5 files among the arguments, but for one to be written (--out): HDF5 may crash on them or
/// come to no end.
std::string hdf5_arguments(int argc, char** argv);

/// Returns what `work` on such `files` returns, in a process of its own that ends with this one.
/// Signals to this one are passed on. Where a library crashes there, or comes to no end, tells it
/// in one line and returns exit_code::bad_input.
int in_own_process(const std::string& files, const std::function<int()>& work);

}  // namespace hagfish
