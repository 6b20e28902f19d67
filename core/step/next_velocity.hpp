// Half steps of the midpoint rule: the rows are of the velocity w by which a step moves, to which
// half of what forces make of it belongs, and all of what impacts do.
#pragma once

namespace hagfish {

struct StepSolution;

/// λ of the whole step, 2 λ_w - μ, from that of w and the impacts μ.
void end_half(StepSolution& step);

}  // namespace hagfish
