// All that a run needs to go on bit by bit as if nothing had been.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/log/log_frame.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

/// Whether `bytes` begin as a checkpoint of an earlier version of this program, which decode()
/// refuses.
bool is_older_checkpoint(std::span<const std::uint8_t> bytes);

/// What a log keeps between its frames.
struct LogState {
  RunningMeans means;
  Worst worst;
  std::string warnings;  ///< all so far, a line each
};

/// Bytes that hold a run between two steps. They mean the same to a program of the same version on
/// a machine of the same byte order; their layout carries a number of its own.
std::vector<std::uint8_t> encode(const Simulation& sim, const LogState& log);

/// The run again, with the back end that it had: the same steps follow. `log` is of the model's
/// size. Throws FileError where `bytes` are of another layout, end early or late, or do not fit
/// the model.
Simulation decode(std::span<const std::uint8_t> bytes, const Model& model,
                  const std::string& back_end, LogState& log);

}  // namespace hagfish
