// The reflex: every joint copies its tailward neighbour (addition). It slides a knot to the head
// without Eq. 6, without a model of the body and without knowing that there is a knot.
//
//   q_ref(s) = q(s) + q̂(s + Δ) - q̂(s)
//
// Here s is the arc length from the head, Δ a small length, and q̂ what the animal senses of its own
// shape; bending about Y, bending about Z and twist each copy themselves. Muscles pull to q_ref as
// they do to a curvature program (active_curvature.hpp). So the animal's present shape, shifted by
// Δ towards the head, is the shape that it takes next.
//
// Where nothing but the body's own damping C resists, C ∂κ/∂t = (B_a + B) Δ ∂κ/∂s with the
// stiffness B_a of the muscles and B of the body. Its solution is any shape κ that travels
// headward,
//   κ(s, t) = κ(s + v t, 0),  v = Δ (B_a + B) / C.
// A knot is such a shape.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/run/laws.hpp"

namespace hagfish {

/// Whether joints copy in this phase: from when the knot is tied until it is released.
bool reflex_acts(Phase phase);

/// Δ of a phase, cm: on a way back to the tail it is turned round, and a pull may have its own.
double reflex_shift(const ReflexSettings& reflex, Phase phase);

/// How late the senses are, in steps: ReflexSettings::delay.
int reflex_lag(const Scene& scene);

/// What hinge `k` copies: the angle (rad) that it would have with the curvature that its kind has
/// at `shift` (cm) behind it. `angles` are those of all hinges, rad; curvature is linear between
/// hinges of one kind, and 0 from one spacing past the last one on, at either end.
double copied_angle(const Model& model, const Eigen::VectorXd& angles, int k, double shift);

/// Storage of reflex_law.
struct ReflexStorage {
  Eigen::VectorXd own, sensed;  ///< angles of the hinges, rad
};

/// The curvature program while the knot forms; then the reflex until the knot is released; then the
/// muscles let go, as by the paper's law. There are no rows of Eq. 6 at any time.
/// q(s) is where the motion of the step's start leads by the time at which the step's forces act:
/// without that a step would be a delay. The senses show the same, or the angles some steps ago,
/// and at first those of the reflex's first step.
///
/// `memory`: empty where the senses are not late, or do not matter; else what they show in this
/// step, and then the angles of the last steps, in a ring.
void reflex_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                ReflexStorage& storage);

/// How many numbers that is.
Eigen::Index reflex_memory_size(const Model& model, const Scene& scene);

/// What keeps a scene from having the reflex.
std::optional<SceneFault> reflex_fault(const Specimen& specimen, const Scene& scene);

}  // namespace hagfish
