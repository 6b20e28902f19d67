// Quadratic programs built from their solutions, for every back end's tests. All draws come from
// the generator given, so a seed names a problem.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "solvers/box_qp.hpp"
#include "solvers/primal_qp.hpp"

namespace hagfish {

/// What a row does at the solution; λ and excess C v - d are drawn from [0.1, 1] where not named.
enum class Role {
  bilateral,   ///< excess 0, multiplier of either sign; these come first
  active,      ///< λ > 0, excess 0
  inactive,    ///< λ = 0, excess > 0
  degenerate,  ///< λ = 0, excess 0
  soft,        ///< 0 < λ < cap, excess 0
  at_cap,      ///< λ = cap, excess < 0
  copy,        ///< the row before it over again in another unit: multipliers are not unique
};

/// A problem and its solution. v is unique; so is x where no role is `copy`.
struct KnownQp {
  PrimalQp primal;
  BoxQp dual;
  Eigen::VectorXd v;
  Eigen::VectorXd x;  ///< multipliers of G, then of C
};

/// `n` velocities and one row for each role. H = B B' + I in units spread evenly in the logarithm
/// over [1/spread, spread], rows likewise. At most n roles may touch their rows.
KnownQp known_qp(std::mt19937& random, Eigen::Index n, const std::vector<Role>& roles,
                 double spread = 1);

/// `count` copies of each role, in the order of the enumeration without `copy`.
std::vector<Role> each_role(int count);

/// All rows unilateral: l = 0, u infinite. A is m x m, b has m entries.
BoxQp unilateral_qp(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// The same for rows J (m x n) where H = I: A = J J'.
BoxQp qp_of_rows(const Eigen::MatrixXd& J, const Eigen::VectorXd& b);

/// v = H⁻¹ (g + [G; C]' x): the velocity that belongs to multipliers.
Eigen::VectorXd velocity_of(const PrimalQp& primal, const Eigen::VectorXd& x);

/// |v - other| in the H norm, over |other|: an error that knows no units.
double velocity_error(const PrimalQp& primal, const Eigen::VectorXd& v,
                      const Eigen::VectorXd& other);

}  // namespace hagfish
