// The reflex: every joint copies its tailward neighbour (addition). It slides a knot to the head
// without Eq. 6 and without a model of the body, and it does not know that there is a knot.
//
//   q_ref(s) = q(s) + q̂(s + Δ) - q̂(s)
//
// Here s is the arc length from the head, Δ a small length, and q̂ the shape that the animal
// senses. Bending about Y, bending about Z and twist are copied separately. Muscles pull to q_ref
// as they do to a curvature program (active_curvature.hpp). So the animal's next shape is its
// present shape, shifted by Δ towards the head.
//
// If only the body's own damping C resists, C ∂κ/∂t = (B_a + B) Δ ∂κ/∂s with the stiffness B_a of
// the muscles and B of the body. Any shape κ that travels headward is a solution,
//   κ(s, t) = κ(s + v t, 0),  v = Δ (B_a + B) / C.
// A knot is such a shape.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/control/laws.hpp"

namespace hagfish {

/// Whether joints copy in this phase: from the end of tying until the release.
bool reflex_acts(Phase phase);

/// Δ of a phase, cm. It is negative on a slide back to the tail, and a pull may have its own.
double reflex_shift(const ReflexSettings& reflex, Phase phase);

/// Delay of the senses in steps: ReflexSettings::delay.
int reflex_lag(const Scene& scene);

/// What hinge `k` copies: the angle (rad) that it would have with the curvature that its kind has
/// at `shift` (cm) behind it. `angles` are those of all hinges, rad. Curvature is linear between
/// hinges of one kind. Beyond either end it is 0 from one spacing past the last hinge on.
double copied_angle(const Model& model, const Eigen::VectorXd& angles, int k, double shift);

/// Storage of reflex_law.
struct ReflexStorage {
  Eigen::VectorXd own, sensed;  ///< angles of the hinges, rad
};

/// The curvature program while the knot forms, then the reflex until the release. Then the muscles
/// let go, as by the paper's law. There are never rows of Eq. 6. q(s) is predicted by the step's
/// first velocity for the time at which the step's forces act, since otherwise a step would add a
/// delay. The senses show the same angles, or those of some steps ago; at first they show the
/// angles of the reflex's first step.
///
/// `memory`: empty where the senses have no delay or do not matter. Else the sensed angles of this
/// step, then the angles of the last steps in a ring.
void reflex_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                ReflexStorage& storage);

/// Length of this memory.
Eigen::Index reflex_memory_size(const Model& model, const Scene& scene);

/// The reason why a scene cannot have the reflex, if any.
std::optional<SceneFault> reflex_fault(const Specimen& specimen, const Scene& scene);

}  // namespace hagfish
