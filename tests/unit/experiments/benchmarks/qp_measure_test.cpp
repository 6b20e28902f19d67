#include "experiments/benchmarks/qp_measure.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/foreign_qps.hpp"
#include "tests/support/random_qp.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::qp_measure_test {

class QpMeasureTest : public testing::Test {
 protected:
  /// Writes a set and measures `back_ends` on it.
  QpReport report_of(const std::vector<StoredQp>& qps, const std::vector<BackEnd>& back_ends) {
    QpSetWriter set(file, true, "", "");
    for (const StoredQp& qp : qps) {
      set.append(qp, 0);
    }
    set.finish();
    return measure(QpSetReader(file), back_ends, 2);
  }

  static KnownQp known(int seed, int count = 4) {
    std::mt19937 random(seed);
    return known_qp(random, 40, each_role(count));
  }

  TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.qps";
};

TEST(Quantile, IsByNearestRank) {
  EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile({4, 3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile({5}, 0.99), 5);
  std::vector<double> values(200);
  for (int i = 0; i < 200; ++i) values[i] = 200 - i;
  EXPECT_EQ(quantile(values, 0.99), 198);
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 1), 200);
}

TEST_F(QpMeasureTest, MeasuresEachBackEndColdAndWarm) {
  std::vector<StoredQp> qps;
  for (int seed = 0; seed < 4; ++seed) {
    const KnownQp k = known(seed);
    qps.push_back({k.dual, std::nullopt, k.x, 0, ""});
  }
  const QpReport report =
      report_of(qps, {{"active-set"}, {"ipopt-unpolished"}, {"ipopt-unpolished", 1e-3}});
  ASSERT_EQ(report.rows.size(), 6u);
  EXPECT_EQ(report.row_counts, (std::vector<Eigen::Index>(4, 24)));
  EXPECT_EQ(report.primal, 0u);
  EXPECT_EQ(report.stored_starts, 4u);
  EXPECT_EQ(report.without_reference, 0u);
  for (std::size_t k = 0; k < 6; ++k) {
    const Performance& row = report.rows[k];
    EXPECT_EQ(row.warm, k % 2 == 1);
    EXPECT_EQ(row.failures, 0);
    ASSERT_EQ(row.time.size(), 4u);
    for (const double time : row.time) {
      EXPECT_GT(time, 0);
      EXPECT_LT(time, 1) << "s";
    }
  }
  EXPECT_LT(report.rows[1].iterations, report.rows[0].iterations) << "the starts are solutions";
  // Pivoting ends at rounding, 1e-15 times a condition of 1e3; an interior point at its tolerance.
  const auto error = [&](int row) { return report.rows[row].velocity.relative; };
  EXPECT_LE(report.rows[0].kkt, 1e-12);
  EXPECT_LE(error(0), 1e-12);
  EXPECT_GT(report.rows[2].kkt, 1e-12);
  EXPECT_GT(error(2), error(0));
  EXPECT_GT(error(4), 10 * error(2)) << "looser by 1e6";
}

TEST_F(QpMeasureTest, CarriesAnswersOverWithinASequence) {
  // The same QP over and over: a carried start is its solution, unless something broke off.
  const KnownQp same = known(1), smaller = known(2, 3);
  const auto box = [](const KnownQp& k, std::optional<std::int64_t> sequence) {
    return StoredQp{k.dual, std::nullopt, {}, sequence, ""};
  };
  const std::vector<BackEnd> back_ends = {{"active-set"}};
  const QpReport alone = report_of({box(same, 0)}, back_ends);
  EXPECT_EQ(alone.carried_starts, 0u);
  const std::int64_t cold = alone.rows[1].iterations;
  const auto warm = [&](const std::vector<StoredQp>& qps, std::size_t carried,
                        std::size_t sequences) {
    const QpReport report = report_of(qps, back_ends);
    EXPECT_EQ(report.carried_starts, carried);
    EXPECT_EQ(report.sequences, sequences);
    return report.rows[1].iterations;
  };
  EXPECT_LT(warm({box(same, 0), box(same, 0)}, 1, 1), 2 * cold);
  EXPECT_EQ(warm({box(same, 0), box(same, 1)}, 0, 2), 2 * cold) << "another sequence";
  EXPECT_EQ(warm({box(same, {}), box(same, {})}, 0, 2), 2 * cold) << "no sequence";
  EXPECT_GT(warm({box(same, 0), box(smaller, 0), box(same, 0)}, 0, 1), 2 * cold) << "rows";
  StoredQp primal = box(same, 0);
  primal.primal = same.primal;
  primal.primal->cap.setConstant(std::numeric_limits<double>::infinity());
  EXPECT_EQ(report_of({box(same, 0), primal, primal}, back_ends).carried_starts, 1u)
      << "from bounded rows to bilateral ones";
}

TEST_F(QpMeasureTest, MeasuresVelocitiesOfPrimalQps) {
  {
    ForeignQps set(file);
    set.problem("0");
    put_primal(set);
    set.problem("1");
    put_box(set);
  }
  const QpReport report = measure(QpSetReader(file), {{"ipopt-unpolished", 1e-3}}, 1);
  EXPECT_EQ(report.primal, 1u);
  EXPECT_GT(report.rows[0].velocity.largest, 0);
  // |v|∞ = 1.5 and 2 without rows, and the box problem knows no v.
  EXPECT_NEAR(report.rows[0].velocity.largest_relative, report.rows[0].velocity.largest / 2, 1e-15);
}

TEST_F(QpMeasureTest, CountsWhatIsSolvedButHasNoSolution) {
  {
    ForeignQps set(file);
    set.problem("0");
    put_contradiction(set);
    set.replace("d", {1, -1 + 1e-5});  // by less than a loose back end minds
    set.problem("1");
    put_primal(set);
  }
  const QpReport report = measure(QpSetReader(file), {{"ipopt-unpolished", 1e-3}}, 1);
  EXPECT_EQ(report.rows[0].failures, 0);
  EXPECT_EQ(report.without_reference, 1u);
}

TEST_F(QpMeasureTest, CountsFailuresAndTellsTheFirst) {
  {
    ForeignQps set(file);
    for (int i = 0; i < 15; ++i) {
      set.problem(std::to_string(i));
      i < 12 ? put_contradiction(set) : put_box(set);
    }
  }
  const QpReport report = measure(QpSetReader(file), {{"active-set"}, {"ipopt"}}, 1);
  for (const Performance& row : report.rows) {
    EXPECT_EQ(row.failures, 12);
    EXPECT_EQ(row.time.size(), 15u);
    EXPECT_LE(row.kkt, 1e-12) << "of those solved";
  }
  EXPECT_EQ(report.without_reference, 0u);
  ASSERT_EQ(report.failures.size(), 10u);
  EXPECT_EQ(report.failures[0].rfind("/qp/0: active-set, cold: infeasible (", 0), 0u)
      << report.failures[0];
}

}  // namespace hagfish::qp_measure_test
