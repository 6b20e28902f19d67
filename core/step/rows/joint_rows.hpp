// Rows on coordinates: the head clamp and the limits of joints. They are appended to the list of a
// step, which reuses its storage.
#pragma once

#include <vector>

#include "core/step/rows/unilateral.hpp"

namespace hagfish {

/// The row of a joint bent by `bend`, without a right-hand side: the exact rate of the angle that
/// is left to its cone. `number` counts the rows of the cone in a step.
Row cone_row(const BendingCone& cone, const Bend& bend, int number);

/// Six bilateral rows that hold the root at the origin without rotation (paper, Eq. 3). They
/// correct a drift at the rate baumgarte / h.
void append_head_rows(const State& state, const ConstraintSettings& settings, double h,
                      std::vector<Row>& rows);

/// One row for each bounded side of each hinge, the nearer side first, and one for each cone unless
/// its joint is straight.
void append_limit_rows(const Model& model, const State& state, const ConstraintSettings& settings,
                       double h, const NearBinding& wanted, std::vector<Row>& rows);

}  // namespace hagfish
