// A run as its judge sees it: steps, and frames with what happened since the frame before. Both
// come from steps as they are taken (run_watch.hpp), or from a log (replay.hpp).
#pragma once

#include <optional>

#include "core/log/log_frame.hpp"

namespace hagfish {

/// The figures of a step that the judge looks at.
struct RunStep {
  Worst worst;   ///< worst figures of this step alone
  int eq6 = -1;  ///< -1 no rows of Eq. 6, 0 with slack, 1 met
};

struct RunFrame {
  double time = 0;  ///< s
  Phase phase = Phase::form;
  bool clamped = false;          ///< the head is, in the step that begins here
  bool at_end = false;           ///< the state at the run's end, where no step begins
  std::optional<KnotSpan> span;  ///< extent of the knot
  Eigen::VectorXd q;             ///< nq
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();  ///< force on the tip, of the step here, dyn
  /// Means over the steps since the frame before, dyn and dyn cm, nv each; nan at the first frame.
  Eigen::VectorXd active, thigmotaxis, head, obstacles;
  double rows = 0;  ///< sum of the mean λ / h of all rows of Eq. 6, dyn
  EnergyLedger energy;
  MomentumLedger momentum;

  /// Largest torque of a hinge, the animal's own and f_thigmo together, dyn cm.
  double largest_torque() const {
    return (active + thigmotaxis).tail(active.size() - root_dofs).lpNorm<Eigen::Infinity>();
  }
};

}  // namespace hagfish
