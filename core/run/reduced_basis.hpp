// Few numbers slide a knot (addition): the paper closes with the conjecture that a few basis
// functions may do, since the sliding force is smooth along the body. In place of the rows of Eq. 6
// stand torques u = B a of few shapes along the body, with numbers a that are found now and then
// from a model of the next moments, or played by the knot's place alone.
#pragma once

#include <Eigen/Core>

#include "core/run/controller.hpp"
#include "core/run/untaken_step.hpp"

namespace hagfish {

/// What the law keeps from step to step: its `memory`, by name.
struct ReducedBasisMemory {
  double next = 0;           ///< time at which a is found again, s
  KnotSpan window;           ///< of the knot, smoothed and without its margin, cm of arc
  Eigen::VectorXd aim, now;  ///< a as last found, and as the torques have it, dyn cm
};

/// The shapes of the scene's basis at the hinges, nv x basis_size, 0 at the root, where the knot
/// has `window`. Those about Z and of twist change sign with Scene::mirror.
void basis_shapes(const Model& model, const Scene& scene, const KnotSpan& window,
                  Eigen::MatrixXd& shapes);

/// Storage of reduced_basis_law.
struct ReducedBasisStorage {
  ReducedBasisMemory memory;
  Eigen::MatrixXd shapes;
  UntakenStep ahead;  ///< one long step of the period, as the model of the next moments
};

/// The paper's law but for the slide, where torques u = B a take the place of the forces of Eq. 6:
/// its rows stay, with no effort, so that the run shows how far they are met. Each period a is the
/// least that meets Eq. 6 at the end of one linearly implicit step of that length through the O(n)
/// model, with the contacts and limits held that bear in it where the paper's law has its way.
/// `memory` holds a ReducedBasisMemory in the slide, else nothing.
void reduced_basis_law(const Situation& at, Eigen::VectorXd& memory, Control& control,
                       ReducedBasisStorage& storage);

/// What `memory` of the law holds. It is not empty.
void unpack(const Eigen::VectorXd& memory, ReducedBasisMemory& unpacked);

}  // namespace hagfish
