// A few numbers slide a knot (addition). The paper closes with the conjecture that a few basis
// functions may be enough, since the sliding force is smooth along the body. Torques u = B a of a
// few shapes along the body replace the rows of Eq. 6. The numbers a are found at intervals from a
// model of the next moments, or follow from the place of the knot alone.
#pragma once

#include <Eigen/Core>

#include "core/control/controller.hpp"
#include "core/control/untaken_step.hpp"

namespace hagfish {

/// The law's `memory`, by name.
struct ReducedBasisMemory {
  double next = 0;           ///< time at which a is computed again, s
  KnotSpan window;           ///< the knot's window, smoothed and without its margin, cm of arc
  Eigen::VectorXd aim, now;  ///< a as last found, and as the torques have it, dyn cm
};

/// The shapes of the scene's basis at the hinges for a knot with this `window`, nv x basis_size, 0
/// at the root. Those about Z and of twist change sign with Scene::mirror.
void basis_shapes(const Model& model, const Scene& scene, const KnotSpan& window,
                  Eigen::MatrixXd& shapes);

/// Storage of reduced_basis_law.
struct ReducedBasisStorage {
  ReducedBasisMemory memory;
  Eigen::MatrixXd shapes;
  UntakenStep ahead;  ///< one long step of the period, as the model of the next moments
};

/// The law all_contacts except in the slide, where torques u = B a replace the forces of Eq. 6. The
/// rows stay, with zero effort, so that the log shows how far they are met. In each period a is the
/// smallest that meets Eq. 6 at all contacts at the end of one linearly implicit step of that
/// length through the O(n) model. This step holds the contacts and limits that carry force when
/// all_contacts acts.
/// `memory` holds a ReducedBasisMemory in the slide, else nothing.
void reduced_basis_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                       ReducedBasisStorage& storage);

/// The contents of a `memory` of the law, which must not be empty.
void unpack(const Eigen::VectorXd& memory, ReducedBasisMemory& unpacked);

}  // namespace hagfish
