// Checks the path of a solved step. Contact rows are linear in q̇, but the path is not. In a long
// step, strands that the rows kept apart may overlap at its end or pass each other on the way. Such
// a pair gets a row that accounts for what the linear row misses, and the step is solved again.
// Cones of universal joints are curved, so a step along the tangent of a cone leaves it. Such a
// joint gets one more tangent.
#pragma once

#include <vector>

#include "core/step/step_input.hpp"
#include "core/step/step_solution.hpp"

namespace hagfish {

/// A step whose path needs more samples than this is not taken.
inline constexpr int most_path_samples = 10000;

/// Overlap that is accepted on the path of a step, as a share of `stride`. It only has to keep
/// strands from passing through each other.
inline constexpr double way_tolerance = 0.25;

/// The number of samples of the path of a step of h (s) such that no body moves further than
/// `stride` (cm) between two of them, for an observer who moves with `observer` (cm/s). 1 is the
/// end alone.
int path_samples(const Eigen::Matrix3Xd& centre_velocity, const Eigen::Vector3d& observer, double h,
                 double stride);

/// Checks the contacts and the gaps to planes of `there`, which is where the velocities of `step`
/// lead within time `t` (s). Returns a row for each overlap deeper than `constraints.tolerance`,
/// between the same material points. Before the step's end (t < h) way_tolerance times
/// `stride` is permitted instead. C is taken at `place`, where the equations hold:
///     φ_now + h C q̇ + (φ_there - φ_now - t C q̇_step) (h/t)² >= goal.
/// The bracket is the error of the linear row at t, of second order. The goal is 0, or what the
/// Baumgarte gain leaves of an earlier overlap. No row asks for h C q̇ over `stride`. The first
/// added row of a contact replaces the row of the step's start. Later rows come on top of it, since
/// strands turn about the points of one row and may meet elsewhere. A plane has one row per body:
/// the new row replaces it. Flesh may overlap and gets none.
std::vector<PathRow> missed_rows(const StepInput& in, const StepPlace& place,
                                 const Observation& there, double t, const StepSolution& step);

/// Angle past a cone that is accepted at the end of a step, rad. The next step leaves half of it
/// (Baumgarte) and may add as much. The sum is at most 1e-5 rad, 0.0006 degrees, below the 0.001
/// degrees that a log may show (ExpectSettings::limit_violation).
inline constexpr double bend_tolerance = 5e-6;

/// Checks the cones of universal joints, with coordinates `there` (nq) at the end of the step.
/// Returns one more row for each joint that is further past its cone than bend_tolerance and what
/// the Baumgarte gain leaves of an earlier violation. The row is the tangent of the cone at the
/// bend of `there`. The angles within a cone are a convex set, which no tangent cuts. So earlier
/// rows stay, and a path that ends within the cone has never left it.
std::vector<PathRow> missed_bends(const StepInput& in, const Eigen::VectorXd& there,
                                  const StepSolution& step);

}  // namespace hagfish
