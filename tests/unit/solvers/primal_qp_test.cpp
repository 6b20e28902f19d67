// Eq. 4 in its velocities, and as the box QP in its multipliers.
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/random_qp.hpp"

namespace hagfish::primal_qp_test {

TEST(PrimalQp, RejectsBadInput) {
  std::mt19937 random(17);
  KnownQp known = known_qp(random, 5, {Role::active});
  known.primal.cap.resize(0);
  EXPECT_THROW(check_primal_qp(known.primal), std::invalid_argument);
  known = known_qp(random, 5, {Role::active});
  known.primal.H(0, 0) = -1;
  EXPECT_THROW(dual_of(known.primal), std::invalid_argument);
}

TEST(DualOf, HasTheGradientThatItsHeaderStates) {
  // w = A x - b equals C v - d for any x, with v = H⁻¹ (g + C' x).
  std::mt19937 random(18);
  const KnownQp known = known_qp(random, 10, {Role::bilateral, Role::active, Role::inactive});
  const Eigen::VectorXd x = Eigen::Vector3d(0.3, -0.2, 0.7);
  const Eigen::VectorXd v = velocity_of(known.primal, x);
  Eigen::VectorXd w(3);
  w << known.primal.G * v - known.primal.e, known.primal.C * v - known.primal.d;
  // Rounding of sums of ten terms of size 1.
  EXPECT_LE((known.dual.A * x - known.dual.b - w).lpNorm<Eigen::Infinity>(), 1e-13);
}

}  // namespace hagfish::primal_qp_test
