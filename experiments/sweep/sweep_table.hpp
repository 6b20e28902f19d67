// The rows of one part of a sweep on disk: made cell by cell in any order, whole in order.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/log/hdf5/output_file.hpp"
#include "experiments/sweep/appended_file.hpp"
#include "experiments/sweep/grid.hpp"

namespace hagfish {

/// Part `index`, from 1 to `count`, of the cells of a grid: each count-th from the index-th on, so
/// that neighbours, which take about equally long, go to different parts.
struct SweepPart {
  std::size_t index = 1, count = 1;
  std::vector<std::size_t> cells(std::size_t size) const;
};

/// Makes `folder` the folder of the sweep that `identity` describes (grid_identity), in sweep.toml.
/// Throws FileError where it holds another one, naming the first line that differs, or cannot be
/// written.
void claim_folder(const std::filesystem::path& folder, const std::string& identity);

/// While it is made, TABLE.part has a line for each cell that is done, with its CPU time last: what
/// is there survives whatever ends the process. When whole, the lines are sorted, without that
/// time, and named TABLE; cells and times stand in TIMES beside it. TABLE is table.csv, or
/// table.I-of-N.csv of a part; TIMES likewise.
class SweepTable {
 public:
  /// Goes on where a process that is gone left it. Throws FileError where another process is at
  /// work on this part, its TABLE.part is damaged, or the folder cannot be written.
  SweepTable(const std::filesystem::path& folder, const SweepPart& part, std::size_t size,
             const std::vector<std::string>& heading);

  /// Cells that have no row yet, in order; none of a table that is whole.
  std::vector<std::size_t> missing() const;
  std::size_t cell_count() const { return cells_.size(); }

  /// Appends the row of `cell`. Throws FileError where that fails.
  void add(std::size_t cell, const std::vector<std::string>& fields, double cpu_time);

  /// Names the table, all of whose rows are there. Throws FileError where that fails.
  void finish();

 private:
  void read_rows();
  std::filesystem::path table_, times_;
  std::vector<std::size_t> cells_;  ///< cells of the part
  std::string heading_;
  std::unique_ptr<OutputFile> file_;  ///< none where the table is whole
  std::unique_ptr<AppendedFile> rows_;
  std::vector<std::size_t> done_;  ///< sorted when read
};

}  // namespace hagfish
