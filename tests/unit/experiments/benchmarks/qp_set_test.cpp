// Sets of QPs, written and read back, and as others write them.
#include "experiments/benchmarks/qp_set.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/support/errors.hpp"
#include "tests/support/foreign_qps.hpp"
#include "tests/support/random_qp.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish::qp_set_test {

namespace fs = std::filesystem;

class QpSetTest : public testing::Test {
 protected:
  /// The error of reading what `put` writes once `spoil` has been at it.
  std::string error_with(const std::function<void(ForeignQps&)>& put,
                         const std::function<void(ForeignQps&)>& spoil) const {
    {
      ForeignQps set(file);
      set.problem("0");
      put(set);
      spoil(set);
    }
    return error_of([&] { QpSetReader(file).read(0); });
  }

  void expect_refused(const std::function<void(ForeignQps&)>& put,
                      const std::function<void(ForeignQps&)>& spoil,
                      const std::string& reason) const {
    EXPECT_EQ(error_with(put, spoil), file + ": /qp/0: " + reason);
  }

  TemporaryFolder folder;
  const std::string file = folder / "a.qps";
};

TEST_F(QpSetTest, ReadsBackWhatItWrote) {
  std::mt19937 random(41);
  KnownQp first = known_qp(random, 20, each_role(2));
  KnownQp second = known_qp(random, 10, {Role::bilateral, Role::active, Role::inactive});
  for (Eigen::MatrixXd* symmetric : {&first.dual.A, &second.primal.H}) {  // to the last bit
    *symmetric = (0.5 * (*symmetric + symmetric->transpose())).eval();
  }
  {
    QpSetWriter set(file, false, "as typed", "title = 'none'");
    EXPECT_FALSE(fs::exists(file)) << "before it is finished";
    set.append({first.dual, std::nullopt, first.x, 7, ""}, 3);
    set.append({second.dual, second.primal, {}, 8, ""}, 9);
    EXPECT_EQ(set.size(), 2u);
    set.finish();
  }
  const QpSetReader set(file);
  ASSERT_EQ(set.size(), 2u);
  const StoredQp box = set.read(0);
  EXPECT_EQ(box.group, "/qp/000000");
  EXPECT_EQ(box.sequence, 7);
  EXPECT_FALSE(box.primal);
  EXPECT_EQ(box.box.A, first.dual.A);
  EXPECT_EQ(box.box.b, first.dual.b);
  EXPECT_EQ(box.box.lower, first.dual.lower);
  EXPECT_EQ(box.box.upper, first.dual.upper);
  EXPECT_EQ(box.start, first.x);
  const StoredQp primal = set.read(1);
  EXPECT_EQ(primal.sequence, 8);
  ASSERT_TRUE(primal.primal);
  EXPECT_EQ(primal.primal->H, second.primal.H);
  EXPECT_EQ(primal.primal->g, second.primal.g);
  EXPECT_EQ(primal.primal->G, second.primal.G);
  EXPECT_EQ(primal.primal->e, second.primal.e);
  EXPECT_EQ(primal.primal->C, second.primal.C);
  EXPECT_EQ(primal.primal->d, second.primal.d);
  EXPECT_EQ(primal.start.size(), 0);
  const Eigen::MatrixXd A = dual_of(second.primal).A;
  EXPECT_LE((primal.box.A - A).lpNorm<Eigen::Infinity>(), 1e-15) << "symmetric to rounding";
}

TEST_F(QpSetTest, ReadsWhatOthersWrite) {
  {
    ForeignQps set(file);
    set.problem("10");
    put_box(set);
    set.problem("9");  // comes before 10
    put_primal(set);
    set.sequence(-3);
    set.problem("11");  // no rows
    set.matrix("H", 2, {1, 0, 0, 1}, 2);
    set.vector("g", {1, 2});
    set.matrix("C", 0, {}, 2);
    set.vector("d", {});
    set.problem("12");
    set.matrix("A", 0, {}, 0);
    for (const char* name : {"b", "l", "u"}) set.vector(name, {});
    set.problem("13");  // bilateral rows alone
    put_primal(set);
    set.replace("C", 0, {}, 2);
    set.replace("d", {});
    set.matrix("G", 1, {3, 4}, 2);
    set.vector("e", {5});
    set.vector("start", {6});
  }
  const QpSetReader set(file);
  ASSERT_EQ(set.size(), 5u);
  const StoredQp primal = set.read(0);
  EXPECT_EQ(primal.group, "/qp/9");
  EXPECT_EQ(primal.sequence, -3);
  ASSERT_TRUE(primal.primal);
  EXPECT_EQ(primal.primal->C, (Eigen::Matrix2d() << -1, -1, 0, 1).finished());
  EXPECT_EQ(primal.box.b, Eigen::VectorXd(Eigen::Vector2d(1, -2)));
  const StoredQp box = set.read(1);
  EXPECT_EQ(box.group, "/qp/10");
  EXPECT_FALSE(box.sequence);
  EXPECT_EQ(box.start.size(), 0);
  EXPECT_EQ(box.box.upper[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(set.read(2).box.b.size(), 0);
  EXPECT_EQ(set.read(3).box.b.size(), 0);
  const StoredQp bilateral = set.read(4);
  EXPECT_EQ(bilateral.box.A(0, 0), 25);
  EXPECT_EQ(bilateral.box.b[0], 5 - 11);
  EXPECT_EQ(bilateral.box.lower[0], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(bilateral.start[0], 6);
}

/// Spoils a set: one of its datasets is other numbers, a matrix where it has `rows`; or is gone.
using Numbers = std::vector<double>;
auto replaced(const char* name, const Numbers& values) {
  return [=](ForeignQps& s) { s.replace(name, values); };
}
auto replaced(const char* name, hsize_t rows, const Numbers& values) {
  return [=](ForeignQps& s) { s.replace(name, rows, values, values.size() / rows); };
}
auto added(const char* name, const Numbers& values) {
  return [=](ForeignQps& s) { s.vector(name, values); };
}
auto gone(const std::string& name) {
  return [=](ForeignQps& s) { s.h5().unlink("/qp/0/" + name); };
}

TEST_F(QpSetTest, RefusesBadPrimalProblems) {
  const double nan = std::nan("");
  const auto refused = [&](const std::function<void(ForeignQps&)>& spoil, const char* reason) {
    expect_refused(put_primal, spoil, reason);
  };
  refused(gone("C"), "has no C");
  refused(gone("d"), "has no d");
  refused(added("e", {1}), "has no G");
  refused([](ForeignQps& s) { s.matrix("G", 1, {1, 1}, 2); }, "has no e");
  refused(replaced("g", {}), "g is empty");
  refused(replaced("g", {1, 2, 3}), "H is 2 x 2, not 3 x 3");
  refused(replaced("C", 2, {1, 2, 3, 4, 5, 6}), "C is 2 x 3, not 2 x 2");
  refused(replaced("d", {1}), "C is 2 x 2, not 1 x 2");
  refused(replaced("d", 2, {1, 2}), "d is 2 x 1, not a vector");
  refused(added("start", {1}), "start is 1, not a vector of 2");
  refused(replaced("H", 2, {1, 0, 0, nan}), "H has entries that are not finite");
  refused(replaced("g", {1, nan}), "g has entries that are not finite");
  refused(replaced("C", 2, {1, 1, 1, nan}), "C has entries that are not finite");
  refused(replaced("d", {1, -INFINITY}), "d has entries that are not finite");
  refused(added("start", {1, nan}), "start has entries that are not finite");
  refused(replaced("H", 2, {2, 1, 0, 2}), "H is not symmetric");
  refused(replaced("H", 2, {1, 2, 2, 1}), "H is not positive definite");
  refused(replaced("C", 2, {1e200, 0, 0, 1}), "C H⁻¹ C' or C H⁻¹ g overflows");
  const char* either = "must have either H (with g, C, d) or A (with b, l, u)";
  refused(gone("H"), either);
  refused([](ForeignQps& s) { s.matrix("A", 1, {1}, 1); }, either);
}

TEST_F(QpSetTest, RefusesBadBoxProblems) {
  const auto refused = [&](const std::function<void(ForeignQps&)>& spoil, const char* reason) {
    expect_refused(put_box, spoil, reason);
  };
  refused(gone("b"), "has no b");
  refused(replaced("l", {0}), "l is 1, not a vector of 2");
  refused(replaced("b", {1, 2, 3}), "A is 2 x 2, not 3 x 3");
  refused(replaced("b", {INFINITY, 1}), "b has entries that are not finite");
  refused(replaced("l", {1, 0}), "l <= 0 <= u does not hold");
  refused(replaced("u", {std::nan(""), 1}), "l <= 0 <= u does not hold");
  refused(replaced("A", 2, {2, 1, 0, 2}), "A is not symmetric");
  refused(replaced("A", 2, {1, 2, 2, 1}), "A is not positive semidefinite");
}

// That its datasets and groups are none: core/log/hdf5/hdf5_hostile_test.cpp.
TEST_F(QpSetTest, RefusesWhatIsNoSet) {
  const auto failure = [&] {
    return error_of<std::runtime_error>([&] { QpSetReader(file).read(0); });
  };
  H5::H5File(file, H5F_ACC_TRUNC).close();
  EXPECT_EQ(failure(), file + ": has no /qp");
  H5::H5File(file, H5F_ACC_RDWR).createGroup("/qp");
  EXPECT_EQ(failure(), file + ": /qp is empty");
}

}  // namespace hagfish::qp_set_test
