// The state with which a run ends, as the last frame of its log.
#pragma once

#include "core/log/hdf5_reader.hpp"
#include "core/log/log_table.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

/// No step begins at a run's end: all that would be of it is nan, and it has no rows. Phase and
/// clamp are those of the last step; contacts, energy and momentum are of the state.
StepRecord end_record(const Model& model, double time, const Simulation& sim, bool clamped);

/// Whether the last frame of a log that ends before step `next` is the state at the end.
bool has_end_frame(const Hdf5Reader& h5, std::int64_t next);

/// Takes the last frame out of the log `file`, whose `frames` have so many rows.
void drop_end_frame(const std::filesystem::path& file, const SeriesList& frames, hsize_t rows);

}  // namespace hagfish
