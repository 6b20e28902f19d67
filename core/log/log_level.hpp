// How much of a run a log holds. The contract of the format is of `full` logs; the others have
// fewer datasets, some of them in single precision.
#pragma once

#include <string>
#include <vector>

namespace hagfish {

/// Each holds what the ones before it hold.
enum class LogLevel {
  summary,  ///< frames' time, phase, knot, Eq. 6, pull, energies, worst figures
  frames,   ///< also the motion and what acts on it, as figures, tables, replays and films need
  full      ///< every step, and forces at the frames: what an audit needs
};

/// Their names, in the order of the values.
const std::vector<std::string>& log_level_names();
const std::string& log_level_name(LogLevel level);
/// Throws std::invalid_argument where there is none of that name.
LogLevel log_level_called(const std::string& name);

/// Whether a path begins as one of `beginnings`.
bool any_begins(const std::string& path, const std::vector<std::string>& beginnings);

/// Whether a log of this level holds a dataset.
bool holds(LogLevel level, const std::string& path);
/// Whether it holds it in single precision: moments and curvatures; below `full` also what no audit
/// could make up for, the places of bodies and means of forces.
bool in_single_precision(LogLevel level, const std::string& path);
/// Values are rounded to multiples of this, in their unit, which makes them easy to compress; 0 for
/// none. Below `full`, of places and of q, far below anything that is made of them.
double resolution(LogLevel level, const std::string& path);

}  // namespace hagfish
