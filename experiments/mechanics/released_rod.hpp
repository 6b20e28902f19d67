// A smooth motion: an elastic rod of universal joints, clamped at its head, is bent and released.
// It bends with a viscosity of 0.02 s times its rigidity, and touches nothing.
#pragma once

#include <Eigen/Core>

#include "core/scene/settings.hpp"

namespace hagfish {

/// A rod after 0.4 of the period of its slowest small bend, in so many equal steps.
struct ReleasedRod {
  Eigen::Vector3d tail;  ///< middle of the last body, over the rod's length
  double cpu = 0;        ///< s
};
ReleasedRod release(TimeRule rule, int steps);

}  // namespace hagfish
