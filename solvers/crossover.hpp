// The way from an interior point to the vertex next to it.
#pragma once

#include <Eigen/Core>

#include "solvers/active_set_pivoting.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {

/// max_i |x_i - clamp(x_i - w_i)| with w = A x - b: zero at a solution and of the size of the error
/// in x elsewhere, where a product x w is of its square. Rows must have unit diagonal.
double natural_residual(const BoxQp& qp, const Eigen::VectorXd& x);

/// Pivots to the end (ActiveSetPivoting) from `x` (m), which lies within the bounds: rows whose
/// distance to a bound is below their |w| start on that bound, the others with w = 0, of which rows
/// that depend on others stay where they are. `pivoting` holds the point or the contradiction;
/// `qp` must outlive its use.
ActiveSetPivoting::Ending pivot_from(const BoxQp& qp, const Eigen::VectorXd& x,
                                     ActiveSetPivoting& pivoting);

/// The vertex that pivot_from finds next to a point that is nearly right. Returns `x` itself where
/// no settled point is met. An interior point stops at x w = μ, so that rows with both small are
/// off by sqrt(μ); this takes them to rounding. `qp` has unit diagonal and |b| <= 1 in rows that
/// push at 0.
Eigen::VectorXd crossover(const BoxQp& qp, const Eigen::VectorXd& x);

}  // namespace hagfish
