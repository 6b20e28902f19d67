// What every back end must do, on one set of problems.
#include <gtest/gtest.h>

#include <toml.hpp>

#include <Eigen/Cholesky>
#include <limits>
#include <optional>

#include "solvers/box_qp.hpp"
#include "tests/support/random_qp.hpp"

namespace hagfish::every_solver_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Rounding of A x - b: 60 products of size 1 and multipliers up to 10.
constexpr double settled = 1e-12;

class EverySolver : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<BoxQpSolver> solver = make_box_qp_solver(GetParam());

  BoxQpSolution solve_cold(const BoxQp& qp) const {
    return make_box_qp_solver(GetParam())->solve(qp, Eigen::VectorXd::Zero(qp.b.size()));
  }
};

void expect_solved(const BoxQp& qp, const BoxQpSolution& solution) {
  ASSERT_EQ(solution.status, SolveStatus::solved) << solution.message;
  EXPECT_LE(kkt_residuals(qp, solution.x).worst(), settled);
  EXPECT_TRUE((solution.x.array() >= qp.lower.array()).all());
  EXPECT_TRUE((solution.x.array() <= qp.upper.array()).all());
}

TEST_P(EverySolver, FindsKnownSolutions) {
  std::mt19937 random(3);
  for (int count = 1; count <= 8; ++count) {
    const KnownQp known = known_qp(random, 60, each_role(count));
    const BoxQpSolution solution = solve_cold(known.dual);
    expect_solved(known.dual, solution);
    // x of size 1, A of condition up to 1e3: settled to 1e-15 in w.
    EXPECT_LE((solution.x - known.x).lpNorm<Eigen::Infinity>(), settled) << count;
    EXPECT_LE(velocity_error(known.primal, velocity_of(known.primal, solution.x), known.v),
              settled);
  }
}

TEST_P(EverySolver, StopsWhenAskedToAndSolvesTheNextProblem) {
  std::mt19937 random(5);
  const KnownQp known = known_qp(random, 60, each_role(8));
  int asked = 0;
  bool stop = true;
  solver->stop_when([&] {
    ++asked;
    return stop;
  });
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(known.dual.b.size());
  const BoxQpSolution solution = solver->solve(known.dual, nothing);
  EXPECT_EQ(solution.status, SolveStatus::stopped) << solution.message;
  EXPECT_GT(asked, 0);
  EXPECT_LE(asked, 2) << "it goes on";
  EXPECT_TRUE(solution.x.allFinite());
  stop = false;
  expect_solved(known.dual, solver->solve(known.dual, nothing));
}

/// A problem that is solved by hand; without `x` its rows contradict each other.
struct SmallQp {
  const char* name;
  Eigen::MatrixXd A;
  Eigen::VectorXd b, lower, upper;
  std::optional<Eigen::VectorXd> x = {};
};

std::vector<SmallQp> small_qps() {
  using V1 = Eigen::Matrix<double, 1, 1>;
  using V2 = Eigen::Vector2d;
  using V3 = Eigen::Vector3d;
  const V1 four(4);
  const auto of_rows = [](const auto& J) -> Eigen::MatrixXd { return J * J.transpose(); };
  const Eigen::MatrixXd opposite = of_rows(V2(1, -1)), twice = of_rows(V2(1, 2)),
                        still = V2(1, 0).asDiagonal(), nothing = Eigen::Matrix2d::Zero();
  Eigen::Matrix3d beside = Eigen::Matrix3d::Zero();
  beside.topLeftCorner<2, 2>().setOnes();
  const double inf = infinity;
  return {{"a hard row", four, V1(2), V1(0), V1(inf), V1(0.5)},
          {"at its cap", four, V1(2), V1(0), V1(0.3), V1(0.3)},
          {"with nothing to do", four, V1(-2), V1(0), V1(inf), V1(0)},
          {"a free row", four, V1(-2), V1(-inf), V1(inf), V1(-0.5)},
          {"no room between the bounds", four, V1(-2), V1(0), V1(0), V1(0)},
          // The second wants a force but has a cap of 0; v = x0 = 1 alone remains.
          {"no room beside others", of_rows(V3(1, 1, 1)), V3(1, 3, -1), V3(0, 0, 0),
           V3(inf, 0, inf), V3(1, 0, 0)},
          {"soft rows may contradict", opposite, V2(1, 1), V2(0, 0), V2(inf, 3), V2(4, 3)},
          // v = 1 as a bilateral row, then twice the same row.
          {"a bilateral row does it", twice, V2(1, 1.9), V2(-inf, 0), V2(inf, inf), V2(1, 0)},
          {"a bilateral row forbids it", twice, V2(1, 2.1), V2(-inf, 0), V2(inf, inf)},
          {"two bilateral rows", twice, V2(1, 2.1), V2(-inf, -inf), V2(inf, inf)},
          {"a soft one pushes in vain", twice, V2(1, 2.1), V2(-inf, 0), V2(inf, 4), V2(-7, 4)},
          {"one cannot move, and need not", still, V2(1, -1), V2(0, 0), V2(inf, inf), V2(1, 0)},
          {"one cannot move, but must", still, V2(1, 1), V2(0, 0), V2(inf, inf)},
          {"one cannot move, softly", still, V2(1, 1), V2(0, 0), V2(inf, 3), V2(1, 3)},
          {"none can move, but must", nothing, V2(-1, 1), V2(0, 0), V2(inf, inf)},
          // A row that cannot move has next to no scale: what it asks for must not make others look
          // met. Without its upper bound the second row asks for ever more.
          {"beside one that cannot move", beside, V3(0, 0.01, 1), V3(-inf, 0, 0), V3(inf, 2, 3),
           V3(-2, 2, 3)},
          {"for ever more", beside, V3(0, 0.01, 1), V3(-inf, 0, 0), V3(inf, inf, 3)}};
}

TEST_P(EverySolver, SolvesSmallProblemsByHand) {
  for (const SmallQp& small : small_qps()) {
    SCOPED_TRACE(small.name);
    const BoxQp qp{small.A, small.b, small.lower, small.upper};
    BoxQpSolution solution;
    solution.contradicting = {7};  // of a problem before
    solver->solve(qp, Eigen::VectorXd::Zero(qp.b.size()), solution);
    if (small.x) {
      expect_solved(qp, solution);
      EXPECT_LE((solution.x - *small.x).lpNorm<Eigen::Infinity>(), settled);
    } else {
      EXPECT_EQ(solution.status, SolveStatus::infeasible);
      for (const Eigen::Index row : solution.contradicting) EXPECT_LT(row, 2);
    }
  }
}

TEST_P(EverySolver, FindsTheVelocityWhereMultipliersAreNotUnique) {
  std::mt19937 random(4);
  const std::vector<Role> roles = {Role::bilateral, Role::bilateral, Role::active,
                                   Role::copy,      Role::copy,      Role::inactive,
                                   Role::active,    Role::copy,      Role::degenerate};
  for (int trial = 0; trial < 10; ++trial) {
    const KnownQp known = known_qp(random, 12, roles, 10);
    const BoxQpSolution solution = solve_cold(known.dual);
    expect_solved(known.dual, solution);
    EXPECT_LE(velocity_error(known.primal, velocity_of(known.primal, solution.x), known.v),
              settled);
  }
}

TEST_P(EverySolver, TakesMoreActiveRowsThanVelocities) {
  // 30 rows on 6 velocities: A has rank 6.
  std::mt19937 random(5);
  const KnownQp known = known_qp(random, 6, std::vector<Role>(30, Role::active));
  const BoxQpSolution solution = solve_cold(known.dual);
  expect_solved(known.dual, solution);
  EXPECT_LE(velocity_error(known.primal, velocity_of(known.primal, solution.x), known.v), settled);
}

TEST_P(EverySolver, DoesNotDependOnUnits) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 5; ++trial) {
    // Rows in units from 1e-3 to 1e3 and velocities too: A_ii over some 12 decades.
    const KnownQp known = known_qp(random, 40, each_role(5), 1e3);
    const BoxQpSolution solution = solve_cold(known.dual);
    expect_solved(known.dual, solution);
    const Eigen::VectorXd scale = row_scale(known.dual.A);
    EXPECT_LE((solution.x - known.x).cwiseProduct(scale).lpNorm<Eigen::Infinity>(),
              settled * known.x.cwiseProduct(scale).lpNorm<Eigen::Infinity>());
  }
}

TEST_P(EverySolver, SolvesNothing) {
  EXPECT_EQ(solve_cold(unilateral_qp(Eigen::MatrixXd(0, 0), Eigen::VectorXd(0))).status,
            SolveStatus::solved);
  const BoxQpSolution rest =
      solve_cold(unilateral_qp(Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()));
  EXPECT_EQ(rest.status, SolveStatus::solved);
  EXPECT_TRUE(rest.x.isZero(0));
}

TEST_P(EverySolver, HoldsItsOwnAgainstLargeBilateralForces) {
  // A clamp whose multipliers exceed the rest by 1e4: the residuals are relative to b.
  Eigen::Matrix3d A;
  A << 1e-8, 5e-5, 0, 5e-5, 1, 0.1, 0, 0.1, 1;
  BoxQp qp = unilateral_qp(A, Eigen::Vector3d(1e-4, 0.3, 0.2));
  qp.lower[0] = -infinity;
  const BoxQpSolution solution = solve_cold(qp);
  expect_solved(qp, solution);
}

TEST_P(EverySolver, RefusesContradictoryRows) {
  // v >= margin and -v >= margin, alone and among eight rows that are fine.
  for (const double margin : {1.0, 0.1, 1e-2, 1e-3}) {
    BoxQp qp = qp_of_rows(Eigen::Vector2d(1, -1), Eigen::Vector2d(1, -1 + margin));
    EXPECT_EQ(solve_cold(qp).status, SolveStatus::infeasible) << margin;
    std::mt19937 random(8);
    const KnownQp known = known_qp(random, 10, std::vector<Role>(8, Role::active));
    Eigen::MatrixXd J(10, 10);
    const Eigen::MatrixXd root = known.primal.H.llt().matrixL().solve(known.primal.C.transpose());
    J.topRows(8) = root.transpose();
    J.row(8) = J.row(0) + J.row(1);
    J.row(9) = -J.row(8);
    Eigen::VectorXd b(10);
    b << known.dual.b, 1, -1 + margin;
    const BoxQpSolution solution = solve_cold(qp_of_rows(J, b));
    EXPECT_EQ(solution.status, SolveStatus::infeasible) << margin;
    EXPECT_TRUE(solution.x.allFinite());
  }
}

TEST_P(EverySolver, ConvergesFromAnyStart) {
  std::mt19937 random(9);
  const KnownQp known = known_qp(random, 60, each_role(6));
  const BoxQpSolution good = solver->solve(known.dual, known.x);
  expect_solved(known.dual, good);
  EXPECT_LT(good.iterations, solve_cold(known.dual).iterations) << "warm starts should pay";
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(known.x.size());
  for (const double size : {-1.0, 1e-3, 1.0, 1e3, 1e9, infinity}) {
    const BoxQpSolution solution = solver->solve(known.dual, size * ones);
    expect_solved(known.dual, solution);
    EXPECT_LE((solution.x - known.x).lpNorm<Eigen::Infinity>(), settled) << size;
  }
}

TEST_P(EverySolver, RepeatsItselfToTheBit) {
  std::mt19937 random(10);
  const KnownQp first = known_qp(random, 60, each_role(7));
  const KnownQp other = known_qp(random, 30, each_role(3));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(first.x.size());
  const BoxQpSolution before = solver->solve(first.dual, zero);
  solver->solve(other.dual, other.x);
  solver->solve(qp_of_rows(Eigen::Vector2d(1, -1), Eigen::Vector2d(1, 1)), Eigen::Vector2d::Zero());
  solver->solve(first.dual, first.x);
  const BoxQpSolution after = solver->solve(first.dual, zero);
  EXPECT_EQ(before.x, after.x);
  EXPECT_EQ(before.iterations, after.iterations);
  EXPECT_EQ(before.x, solve_cold(first.dual).x) << "a solver of its own";
}

TEST_P(EverySolver, RejectsBadInput) {
  BoxQp qp = unilateral_qp(Eigen::Matrix2d::Identity(), Eigen::Vector2d::Ones());
  EXPECT_THROW(solver->solve(qp, Eigen::VectorXd::Zero(3)), std::invalid_argument);
  qp.A(0, 1) = std::nan("");
  EXPECT_THROW(solver->solve(qp, Eigen::VectorXd::Zero(2)), std::invalid_argument);
}

/// A recorded problem of tests/data and the start that it had.
struct RecordedQp {
  BoxQp qp;
  Eigen::VectorXd start;
};

RecordedQp recorded_qp(const std::string& name) {
  const auto file = toml::parse(std::string(HAGFISH_TEST_DATA_DIR "/") + name);
  const auto numbers = [&file](const char* key) {
    const auto values = toml::find<std::vector<double>>(file, key);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(values.data(), values.size()));
  };
  RecordedQp record{{{}, numbers("b"), numbers("lower"), numbers("upper")}, numbers("start")};
  const Eigen::Index m = record.start.size();
  const Eigen::VectorXd triangle = numbers("A");
  record.qp.A.resize(m, m);
  for (Eigen::Index i = 0, k = 0; i < m; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j, ++k) {
      record.qp.A(i, j) = record.qp.A(j, i) = triangle[k];
    }
  }
  return record;
}

TEST_P(EverySolver, SolvesWhatFullInteriorStepsCycleOn) {
  for (const char* name : {"astray_qp.toml", "cycling_qp.toml"}) {
    const RecordedQp record = recorded_qp(name);
    expect_solved(record.qp, solver->solve(record.qp, record.start));
    expect_solved(record.qp, solve_cold(record.qp));
  }
}

std::string name_of(const testing::TestParamInfo<std::string>& back_end) {
  std::string name = back_end.param;
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(BackEnds, EverySolver, testing::ValuesIn(box_qp_solver_names()), name_of);

}  // namespace hagfish::every_solver_test
