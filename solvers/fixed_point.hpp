// Anderson's acceleration of fixed-point iterations (D. G. Anderson, J. ACM 12, 1965).
#pragma once

#include <Eigen/Core>

namespace hagfish {

/// Speeds up x <- g(x): the next x is the one at which the last few passes, taken as linear, have
/// the least residual g(x) - x (2-norm).
class AndersonMixing {
 public:
  /// Forgets all passes; before the first one of an iteration.
  void restart() { passes_ = 0; }
  /// A pass led from x to g(x) (the same length each time): the next x, which is g(x) after the
  /// first one.
  void mix(const Eigen::VectorXd& x, const Eigen::VectorXd& g, Eigen::VectorXd& next);

 private:
  static constexpr int depth = 3;  ///< changes between passes that are looked back on
  int passes_ = 0;
  Eigen::VectorXd residual_, last_residual_, last_g_;
  Eigen::Matrix<double, Eigen::Dynamic, depth> residual_change_, g_change_;  ///< columns in a ring
};

}  // namespace hagfish
