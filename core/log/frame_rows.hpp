// What the log holds of the rows of the step at a frame: contacts with a force, and rows of Eq. 6.
#pragma once

#include <cstdint>

#include "core/log/log_level.hpp"
#include "core/log/log_table.hpp"
#include "core/log/means/thigmotaxis_rows.hpp"
#include "core/scene/settings.hpp"
#include "core/step/rows/row.hpp"

namespace hagfish {

/// A contact with a force, of the step at a frame.
struct BearingContact {
  std::int32_t frame = 0;  ///< index along the frames
  const Row& row;          ///< a row of kind contact or obstacle
  double force = 0;        ///< λ / h, dyn
};

/// A row of Eq. 6 of the step at a frame.
struct FrameRow {
  std::int32_t frame = 0;  ///< index along the frames
  ThigmotaxisRow row;
};

/// /eq6, a row for each row of Eq. 6 at a frame, at whatever contact (Law::logs_rows); of other
/// laws /thigmotaxis has them all.
LogTable<FrameRow> row_table(LogLevel level);

/// /contacts, a row for each contact with a force at a frame. Which obstacle it is with is said
/// where the scene has others than the head plate.
LogTable<BearingContact> contact_table(const Scene& scene, LogLevel level);

}  // namespace hagfish
