// Half steps of the midpoint rule: the rows are of the velocity w by which a step moves, to which
// half of what forces make of it belongs, and all of what impacts do.
#pragma once

#include <vector>

#include "core/step/rows.hpp"

namespace hagfish {

struct StepSolution;

/// The bounds of half a step's multipliers, from those of a whole one.
void begin_half(std::vector<Row>& rows);

/// λ of the whole step, 2 λ_w - μ, from that of w and the impacts μ; and its bounds.
void end_half(StepSolution& step);

}  // namespace hagfish
