// The tables that `hagfish export` makes of a log: a row a frame and station.
#pragma once

#include <vector>

#include "core/log/reading/log_contents.hpp"
#include "experiments/export/export_table.hpp"
#include "experiments/export/swept_skin.hpp"

namespace hagfish {

/// What every row of a table along the frames begins with.
inline const ExportColumn frame_column{"frame", figure_unit::none, "index of the frame, from 0"};
inline const ExportColumn time_column{"time", figure_unit::second, "simulated time"};

/// midline, curvature, knot, contacts: where the body is, recomputed from q.
std::vector<ExportTable> shape_tables(const LogContents& log, bool si);

/// torques, joints (the same, a column a hinge), moments, eq6, head, energy: what the log has of
/// forces, as means since the frame before, and what it leaves to be computed, the springs.
std::vector<ExportTable> force_tables(const LogContents& log, bool si);

/// phases: a row a phase that the run reached, in the order of time.
ExportTable phases_table(const LogContents& log, bool si);

/// skin: the cells of the skin that the knot has swept or not, `swept`.
ExportTable skin_table(const SweptSkin& swept, const Model& model, bool si);

/// summary: one row.
ExportTable summary_table(const LogContents& log, const SweptSkin& swept, bool si);

}  // namespace hagfish
