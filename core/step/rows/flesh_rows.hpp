// Rows of flesh (core/contact/flesh.hpp): a spring and a damper at each point, taken in the middle
// of the step by either rule, f = -k' w (g + (h/2 + τ) C v). So springs make or take no energy.
// With λ = r f, where r is the reach of the step (TimeSettings::reach), this is
//     C v + λ / (k' w r (h/2 + τ)) = -g / (h/2 + τ),
// in the dual problem of the step a share of the diagonal. Flesh only pushes: λ >= 0. Before skins
// touch (g > 0) there is no damping, and the row says what overlap the step leads to.
#pragma once

#include <vector>

#include "core/step/rows/unilateral.hpp"
#include "core/step/step_input.hpp"

namespace hagfish {

/// Contact::normal of the contact's two `points` in `time` (s), at the velocities of `now`. By
/// Euler's rule rows of flesh on obstacles have that of the middle of the step: where points slip
/// along them, that of its start would rub. Within the body it would turn the body.
Eigen::Vector3d normal_ahead(const Observation& now, const Contact& contact,
                             const BetweenPoints& points, double time);

/// The rows of all points and planes, in place of the rows of hard contact. `at` are the segments
/// where the equations hold, or null at the step's start.
void append_flesh_rows(const StepInput& in, const std::vector<SplineSegment>* at,
                       const NearBinding& wanted, std::vector<Row>& rows);

}  // namespace hagfish
