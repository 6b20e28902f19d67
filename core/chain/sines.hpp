// Sines and cosines of many angles.
#pragma once

#include <Eigen/Core>

namespace hagfish {

/// Of each of `angles` (rad), to two units in the last place; exactly odd and even, so that mirror
/// images stay so. The compiler works several out at once where its library has a function for
/// that.
void sines_and_cosines(const Eigen::Ref<const Eigen::VectorXd>& angles, Eigen::VectorXd& sine,
                       Eigen::VectorXd& cosine);

}  // namespace hagfish
