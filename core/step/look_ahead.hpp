// Looks along the path of a solved step. Contact rows are linear in q̇, the path is not. In a long
// step, strands that the rows kept apart may overlap at its end or pass each other on the way. Such
// a pair gets a row whose right-hand side contains what the linear row misses, and the step is
// solved again. Cones of universal joints are curved, so that a step along their tangent leaves
// them: such a joint gets one more tangent.
#pragma once

#include <vector>

#include "core/step/step_input.hpp"
#include "core/step/step_solution.hpp"

namespace hagfish {

/// A step whose path would ask for more samples than this is not taken.
inline constexpr int most_path_samples = 10000;

/// Overlap that is accepted on the way of a step, as a share of `stride`: strands must not pass
/// through each other there, no more.
inline constexpr double way_tolerance = 0.25;

/// How many samples of the path of a step of h (s) are needed so that no body moves further than
/// `stride` (cm) between two: 1 is the end alone.
int path_samples(const Eigen::Matrix3Xd& centre_velocity, double h, double stride);

/// Goes through the contacts and gaps to planes of `there`, where the velocities of `step` lead
/// within time `t` (s). Each overlap that is deeper than `constraints.tolerance` allows gets a row
/// in step.rows between the same material points, with C taken at `place`, where its equations
/// hold:
///     φ_now + h C q̇ + (φ_there - φ_now - t C q̇_step) (h/t)² >= goal,
/// The bracket is what the linear row misses at t, of second order. The goal is 0, or what the
/// Baumgarte gain leaves of an overlap that was there before. No row asks for h C q̇ over `stride`.
/// The first added row of a contact replaces the row of the step's start. Further ones are added to
/// it: strands turn about the points of one row and may meet elsewhere. A plane's row replaces the
/// one before. Returns whether any row was added.
bool add_missed_rows(const StepInput& in, const StepPlace& place, const Observation& there,
                     double t, StepSolution& step);

/// A bend past its cone that is accepted at the end of a step, rad. The next step leaves half of it
/// (Baumgarte) and may add as much: 1e-5 rad at most, 0.0006 degrees, below the 0.001 that a log
/// may show (ExpectSettings::limit_violation).
inline constexpr double bend_tolerance = 5e-6;

/// The same for the cones of universal joints, with coordinates `there` (nq) at the end of the
/// step. Each joint bent further past its cone than bend_tolerance and what the Baumgarte gain
/// leaves of an earlier violation gets one more row: the cone's tangent at the bend of `there`. The
/// angles within a cone are a convex set, and no tangent cuts it. So earlier rows stay, and a path
/// that ends within the cone has never left it. Returns whether any row was added.
bool add_missed_bends(const StepInput& in, const Eigen::VectorXd& there, StepSolution& step);

}  // namespace hagfish
