// Sets of QPs as HDF5 files: what `hagfish record-qp` writes and `hagfish qp` reads, of any origin.
//
//   /qp/000000   one problem a group, solved in the order of their names (as numbers where they
//   /qp/000001   are), dense, in one of two forms:
//       H, g, C, d and perhaps G, e   min ½ v'Hv - g'v, Gv = e, Cv >= d    (primal_qp.hpp)
//       A, b, l, u                    min ½ x'Ax - b'x, l <= x <= u        (box_qp.hpp)
//     and perhaps `start`, a guess at the multipliers (of G, then of C) or x.
//     Attribute `sequence` (whole number): problems that follow each other with the same one belong
//     to consecutive steps of a run. Without it a problem is a run of its own.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/log/hdf5/hdf5_reader.hpp"
#include "core/log/hdf5/hdf5_writer.hpp"
#include "core/log/hdf5/output_file.hpp"
#include "solvers/box_qp.hpp"
#include "solvers/primal_qp.hpp"

namespace hagfish {

struct StoredQp {
  BoxQp box;                       ///< the problem that back ends solve
  std::optional<PrimalQp> primal;  ///< primal form, if stored so; `box` is then its dual_of
  Eigen::VectorXd start;           ///< m, or empty where none is stored
  std::optional<std::int64_t> sequence;
  std::string group;  ///< "/qp/000000"; not used in writing
};

class QpSetReader {
 public:
  /// Throws FileError where the file is no HDF5, InputError where it holds no problems.
  explicit QpSetReader(const std::filesystem::path& file);
  std::size_t size() const { return names_.size(); }
  /// Throws InputError in one line naming file, group and what is wrong: datasets missing, sizes,
  /// entries that are not finite, H not symmetric and positive definite, A not symmetric and
  /// semidefinite, bounds that leave out 0.
  StoredQp read(std::size_t index) const;

 private:
  Hdf5Reader h5_;
  std::vector<std::string> names_;
};

class QpSetWriter {
 public:
  /// Throws FileError as OutputFile. `scene` is the resolved scene, `command` as typed.
  QpSetWriter(const std::filesystem::path& file, bool replace, const std::string& command,
              const std::string& scene);
  /// Adds a problem in the form that it has, taken from step `step` of a run. The set grows in
  /// memory.
  void append(const StoredQp& qp, std::int64_t step);
  std::size_t size() const { return size_; }
  /// Puts the file on disk.
  void finish();

 private:
  OutputFile file_;
  Hdf5Writer h5_;
  std::size_t size_ = 0;
};

}  // namespace hagfish
