// Audits a log from outside: topology, penetration, limits, drift, residuals, forces, energy. What
// can be recomputed from q, q̇ and the forces is, with the model that the log's own scene makes.
#pragma once

#include <string>
#include <vector>

#include "core/hdf5_reader.hpp"
#include "core/model.hpp"
#include "core/scene_reader.hpp"

namespace hagfish {

struct Finding {
  std::string name;    ///< what was judged, in a word or two
  bool passed = true;  ///< false fails the log
  std::string text;    ///< the figure and its bound, in one line
};

/// A log's scene and the frames that every audit reads.
struct LogContents {
  /// Throws FileError where the file is not a log whose datasets fit its own model.
  explicit LogContents(const std::string& file);
  Hdf5Reader h5;
  ResolvedScene resolved;
  Model model;                          ///< that the scene makes
  std::vector<double> time;             ///< s
  std::vector<std::int64_t> phase;      ///< as Phase
  Hdf5Reader::Rows q, qdot, qdot_next;  ///< frames x nq, nv, nv

 private:
  void check_shapes() const;
};

/// All findings on one log, in the order of its groups. Throws FileError or InputError where the
/// file is not a log of this format and version, or a dataset is missing.
std::vector<Finding> audit(const std::string& file);

}  // namespace hagfish
