// Badly scaled, degenerate and nearly parallel problems: both back ends have the same answer.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "solvers/box_qp.hpp"
#include "tests/support/random_qp.hpp"

namespace hagfish::hard_qp_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// min ½ |v|² - g' v with rows C v >= d and no others.
PrimalQp problem(const Eigen::VectorXd& g, const Eigen::MatrixXd& C, const Eigen::VectorXd& d) {
  const Eigen::Index n = g.size();
  return {Eigen::MatrixXd::Identity(n, n),
          g,
          Eigen::MatrixXd(0, n),
          Eigen::VectorXd(0),
          C,
          d,
          Eigen::VectorXd::Constant(d.size(), infinity)};
}

class HardQp : public testing::TestWithParam<std::string> {
 protected:
  BoxQpSolution solve(const PrimalQp& qp) const {
    return make_box_qp_solver(GetParam())->solve(dual_of(qp), Eigen::VectorXd::Zero(rows(qp)));
  }
  static Eigen::Index rows(const PrimalQp& qp) { return qp.e.size() + qp.d.size(); }
};

/// Bounds that stand for infinity are no part of the answer, however large they are.
TEST_P(HardQp, FarBoundsAreNone) {
  Eigen::Matrix<double, 5, 2> C;
  C << 1, 0, 0, 1, -1, 0, 0, -1, 1, 1;
  for (const double far : {10.0, 1e4, 1e8, 1e12, 1e15}) {
    const PrimalQp qp = problem(Eigen::Vector2d(1, 2), C,
                                (Eigen::VectorXd(5) << -far, -far, -far, -far, 4).finished());
    const BoxQpSolution solution = solve(qp);
    ASSERT_EQ(solution.status, SolveStatus::solved) << far << ": " << solution.message;
    EXPECT_LE((velocity_of(qp, solution.x) - Eigen::Vector2d(1.5, 2.5)).norm(), 1e-14) << far;
  }
}

/// d of a and -3 a, 0.3 and -0.9, differ by rounding alone; so do three multiples of one row.
TEST_P(HardQp, RoundingIsNoContradiction) {
  PrimalQp qp = problem(Eigen::Vector2d::Zero(), Eigen::MatrixXd(0, 2), Eigen::VectorXd(0));
  const Eigen::RowVector2d a(0.1, 0.7);
  qp.C.resize(2, 2);
  qp.C << a, -3 * a;
  qp.d = Eigen::Vector2d(0.3, -0.9);
  qp.cap = Eigen::Vector2d::Constant(infinity);
  const Eigen::Vector2d nearest = 0.3 * a.transpose() / a.squaredNorm();
  BoxQpSolution solution = solve(qp);
  ASSERT_EQ(solution.status, SolveStatus::solved) << solution.message;
  EXPECT_LE((velocity_of(qp, solution.x) - nearest).norm(), 1e-14);
  qp.G.resize(3, 2);
  qp.G << a, 3 * a, -7.3 * a;
  qp.e = Eigen::Vector3d(0.3, 3 * 0.3, -7.3 * 0.3);
  qp.C.resize(0, 2);
  qp.d.resize(0);
  qp.cap.resize(0);
  solution = solve(qp);
  ASSERT_EQ(solution.status, SolveStatus::solved) << solution.message;
  EXPECT_LE((velocity_of(qp, solution.x) - nearest).norm(), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(BackEnds, HardQp, testing::Values("active-set", "ipopt"),
                         [](const auto& tested) {
                           return tested.param == "ipopt" ? "ipopt" : "activeset";
                         });

struct Draw {
  std::mt19937& random;
  double unit() { return 2 * static_cast<double>(random()) / 4294967296.0 - 1; }
  double scale(double decades) { return std::pow(10, decades * unit()); }
  Eigen::RowVectorXd row(Eigen::Index n) {
    return Eigen::RowVectorXd::NullaryExpr(n, [&] { return unit(); });
  }
};

/// Velocities of masses from 1e-3 to 1e3. Rows scaled by up to 1e8 either way: on their own, copies
/// and opposites of others, 1e-9 from others, and touched with no force. A velocity meets all rows
/// with 1e-12 to spare, as rounding of d would make contradictions of opposites. `contradictory`:
/// two opposite rows ask for what cannot be, by a tenth of the velocity's size at least.
PrimalQp draw_problem(Draw draw, bool contradictory) {
  const Eigen::Index n = 2 + draw.random() % 6, m = 2 + draw.random() % 10;
  const Eigen::VectorXd root = Eigen::VectorXd::NullaryExpr(n, [&] { return draw.scale(1.5); });
  const Eigen::VectorXd inside = draw.row(n).transpose();  // in units of equal masses
  Eigen::MatrixXd C(m, n);
  Eigen::VectorXd d(m);
  bool single = false;  // whether the row before is like no other
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto kind = draw.random() % 4;
    Eigen::RowVectorXd row = draw.row(n);
    const bool like = single && (kind == 1 || kind == 2);
    if (like && kind == 1) row = draw.unit() * C.row(i - 1);
    if (like && kind == 2) row = C.row(i - 1) + 1e-9 * C.row(i - 1).norm() * row;
    single = !like;
    const double size = row.norm() * inside.norm();
    C.row(i) = row;
    d[i] = row.dot(inside) - size * (draw.random() % 2 == 0 ? 1e-12 : draw.scale(2));
  }
  if (contradictory) {
    C.row(1) = -C.row(0);
    d[1] = -d[0] + C.row(1).norm() * inside.norm() * draw.scale(1);
  }
  for (Eigen::Index i = 0; i < m; ++i) {
    const double scale = draw.scale(8);
    C.row(i) *= scale;
    d[i] *= scale;
  }
  PrimalQp qp = problem(root.cwiseProduct(draw.row(n).transpose()), C * root.asDiagonal(), d);
  qp.H = root.cwiseAbs2().asDiagonal();
  return qp;
}

/// Of rows that contradict each other: no velocity meets those alone.
bool contradict(const PrimalQp& qp, const std::vector<Eigen::Index>& rows) {
  PrimalQp alone = qp;
  alone.C = qp.C(rows, Eigen::all);
  alone.d = qp.d(rows);
  alone.cap = qp.cap(rows);
  const BoxQp dual = dual_of(alone);
  return make_box_qp_solver("active-set")
             ->solve(dual, Eigen::VectorXd::Zero(dual.b.size()))
             .status == SolveStatus::infeasible;
}

TEST(HardQps, BackEndsAgreeOnFiveHundred) {
  std::mt19937 random(53);
  double apart = 0;
  int solved = 0, named = 0;
  for (int k = 0; k < 500; ++k) {
    const bool contradictory = k % 5 == 4;
    const PrimalQp qp = draw_problem({random}, contradictory);
    const BoxQp dual = dual_of(qp);
    std::array<BoxQpSolution, 2> of;
    for (const int s : {0, 1}) {
      of[s] = make_box_qp_solver(s == 0 ? "active-set" : "ipopt")
                  ->solve(dual, Eigen::VectorXd::Zero(dual.b.size()));
      EXPECT_EQ(of[s].status, contradictory ? SolveStatus::infeasible : SolveStatus::solved)
          << k << " by " << s << ": " << of[s].message;
      if (of[s].status == SolveStatus::infeasible) {
        EXPECT_TRUE(contradict(qp, of[s].contradicting)) << k << " by " << s;
        ++named;
      }
    }
    if (of[0].status == SolveStatus::solved && of[1].status == SolveStatus::solved) {
      const double off = velocity_error(qp, velocity_of(qp, of[1].x), velocity_of(qp, of[0].x));
      EXPECT_LE(off, 1e-10) << k;
      apart = std::max(apart, off);
      ++solved;
    }
  }
  std::cout << solved << " solved, velocities at most " << apart << " apart; " << named
            << " times contradicting rows named\n";
}

}  // namespace hagfish::hard_qp_test
