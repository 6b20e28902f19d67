// Grid files of `hagfish sweep`: TOML, with every setting tried before the first run.
#pragma once

#include <filesystem>

#include "experiments/sweep/grid.hpp"

namespace hagfish {

/// Most cells of a grid: their numbers and the file of their rows stay within what tools take.
inline constexpr double most_cells = 1e9;

/// Reads a grid file:
///     scene = "table1"            # built in, or a file beside this one; or an axis has it
///     set = ["time.step=0.02"]    # of every run
///     seeds = 10                  # start.seed from 1 to this: one more axis, the last
///     keep = "none"               # which logs: or "failed", "all"
///     [[axis]]                    # keys of one axis change together; axes are multiplied
///     "model.limit_scale" = [0.8, 1.0]
///     [[axis]]
///     "drag.normal" = { from = 1, to = 100, count = 5, scale = "log" }   # or "linear"
/// Numbers of a range have nine digits, so that every machine makes the same ones. Throws
/// InputError where a key is unknown, a value out of its range (each is tried, along its axis, with
/// the first ones of the others), an axis has no value, its keys do not have equally many, a key
/// stands twice, seeds have no noise to draw, or there is nothing to sweep.
Grid read_grid(const std::filesystem::path& file);

}  // namespace hagfish
