// What the datasets of a log must be before any of their numbers is used: the log may come from
// anywhere.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/chain/model.hpp"
#include "core/log/hdf5_reader.hpp"
#include "core/log/hdf5_writer.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// Type and extents of a dataset.
struct DatasetForm {
  std::string path;
  std::vector<hsize_t> shape;
  H5T_class_t type;
  std::shared_ptr<const SeriesLayout> layout;  ///< as declared
};

/// Every dataset along frames, steps and contacts as the writer of logs declares it, with the rows
/// that this log has of each: those of /trajectory/time, /steps/kkt and /contacts/frame, where its
/// level has them. Throws FileError where one of these is missing or no series.
std::vector<DatasetForm> log_forms(const Hdf5Reader& log, const Model& model, const Scene& scene);

/// Throws FileError where the log has no such dataset or one of another type or shape.
void check_form(const Hdf5Reader& log, const DatasetForm& form);

/// Whether the last frame is the state at the run's end, behind all of /steps; false of a log
/// without these.
bool ends_with_end_frame(const Hdf5Reader& log);

/// What every reader of a log relies on; throws FileError naming the first dataset that is not so.
/// First, nothing of it read: those that all commands use are there, all that are there (older logs
/// have fewer) have type and shape of `model`, and together they fit into the memory of this
/// machine. Then the values: times rise, steps go up by the scene's stride from 0 or later, but for
/// the state at the end, and are covered by /steps, phases, bodies, frames and kinds of solve
/// exist, positions and velocities are finite and not absurd.
void check_schema(const Hdf5Reader& log, const Model& model, const Scene& scene);

}  // namespace hagfish
