// A reduced basis: what its shapes are, that the numbers found meet Eq. 6 where the model of them
// is the step itself, and that a profile is played by place.
#include "core/control/reduced_basis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/stored_states.hpp"

namespace hagfish::reduced_basis_test {

constexpr double h = 0.002;

class ReducedBasis : public testing::Test, protected SceneRun {
 protected:
  ReducedBasis() : SceneRun(stored_scene()) {
    scene.controller.law = "reduced_basis";
    ReducedBasisSettings& basis = scene.controller.reduced_basis;
    basis.margin = 1;
    basis.cosines = 6;
    basis.period = h;
    basis.softness = 1e-9;
    basis.most = 1e9;
  }
  /// The shapes where the knot is from 10 to 30 cm.
  Eigen::MatrixXd shapes() const {
    Eigen::MatrixXd B;
    basis_shapes(model, scene, {10, 30}, B);
    return B;
  }
  /// Velocity and place of the hinge of body `body` about `axis`.
  int dof_of(int body, Axis axis) const {
    for (std::size_t k = 0; k < model.hinges.size(); ++k) {
      if (model.hinges[k].body == body && model.hinges[k].axis == axis) {
        return root_dofs + static_cast<int>(k);
      }
    }
    throw std::out_of_range("no such hinge");
  }
  double arc_of(int body) const { return model.length() * body / model.body_count(); }
  /// A step of a stored state.
  const StepRecord& step_of(const char* state) {
    sim = resume(model, scene, stored_state(state));
    return step();
  }
  /// The largest shortfall of a row of Eq. 6 in it, cm/s.
  double shortfall(const char* state) {
    const StepSolution& solved = step_of(state).solution;
    double worst = 0;
    for (std::size_t i = 0; i < solved.rows.size(); ++i) {
      if (solved.rows[i].kind == RowKind::thigmotaxis) {
        worst = std::max(worst, -solved.excess[static_cast<Eigen::Index>(i)]);
        EXPECT_EQ(solved.lambda[static_cast<Eigen::Index>(i)], 0);
      }
    }
    return worst;
  }
};

TEST_F(ReducedBasis, CosinesFillTheKnotsWindowAndNothingElse) {
  const Eigen::MatrixXd B = shapes();
  ASSERT_EQ(B.cols(), 18);
  EXPECT_TRUE(B.topRows<root_dofs>().isZero(0));
  for (const auto& [body, axis, column] :
       {std::tuple(41, Axis::y, 0), {41, Axis::z, 6}, {40, Axis::x, 12}}) {
    const double x = (arc_of(body) - 9) / 22;  // a margin of 1 cm on 20 cm
    for (int j = 0; j < 6; ++j) {
      EXPECT_NEAR(B(dof_of(body, axis), column + j), std::cos(std::numbers::pi * j * x), 1e-14);
    }
    EXPECT_EQ((B.row(dof_of(body, axis)).array() != 0).count(), 6);
  }
  EXPECT_TRUE(B.row(dof_of(21, Axis::y)).isZero(0));  // at 8.9 cm
  EXPECT_TRUE(B.row(dof_of(75, Axis::z)).isZero(0));  // at 31.8 cm
}

TEST_F(ReducedBasis, TheMirrorImageBendsAboutYAlike) {
  const Eigen::MatrixXd B = shapes();
  scene.mirror = true;
  const Eigen::MatrixXd mirrored = shapes();
  for (std::size_t k = 0; k < model.hinges.size(); ++k) {
    const auto d = root_dofs + static_cast<Eigen::Index>(k);
    const double sign = model.hinges[k].axis == Axis::y ? 1 : -1;
    EXPECT_EQ(mirrored.row(d), sign * B.row(d));
  }
}

TEST_F(ReducedBasis, LearnedShapesAreLinearBetweenStations) {
  ReducedBasisSettings& basis = scene.controller.reduced_basis;
  basis.cosines = 0;
  basis.frame = BasisFrame::body;
  basis.stations = {0, 20, model.length()};
  basis.bend_y = {0, 2, 0, 1, 1, 1};
  basis.bend_z = {3, 3, 3, 0, 0, 0};
  basis.twist = {0, 0, 0, 0, 4, 0};
  const Eigen::MatrixXd B = shapes();
  ASSERT_EQ(B.cols(), 2);
  EXPECT_NEAR(B(dof_of(11, Axis::y), 0), 2 * arc_of(11) / 20, 1e-14);
  EXPECT_NEAR(B(dof_of(11, Axis::y), 1), 1, 1e-14);
  EXPECT_NEAR(B(dof_of(73, Axis::z), 0), 3, 1e-14);
  const double left = (model.length() - arc_of(80)) / (model.length() - 20);
  EXPECT_NEAR(B(dof_of(80, Axis::x), 1), 4 * left, 1e-13);
}

TEST_F(ReducedBasis, NumbersFoundForOneStepTakeTheWorstRowOfEq6HalfOfItsWay) {
  ReducedBasisSettings& basis = scene.controller.reduced_basis;
  basis.cosines = 8;
  for (const char* state : {"slide", "slide late"}) {
    basis.most = 1e9;
    const double met = shortfall(state);
    basis.most = 1e-9;  // no torque to speak of
    const double missed = shortfall(state);
    EXPECT_GT(missed, 0.05);
    // Not zero: other limits and contacts bear than in the step by Eq. 6, whose are held. Seen 0.36
    // and 0.49 of it. With the sign of the numbers turned the shortfall grows.
    EXPECT_LT(met, 0.6 * missed);
  }
}

TEST_F(ReducedBasis, AProfileIsPlayedByTheKnotsPlaceAlone) {
  ReducedBasisSettings& basis = scene.controller.reduced_basis;
  basis.cosines = 1;
  basis.softness = 0.03;  // fewer numbers than rows
  const double place = knot_span(step_of("slide").controller)->head_end;
  basis.places = {place - 3, place + 1};
  basis.played = {0, 10, 0, 4, 10, 8};
  step_of("slide");
  ReducedBasisMemory memory;
  unpack(record.controller.memory, memory);
  EXPECT_LT((memory.now - Eigen::Vector3d(3, 10, 6)).norm(), 1e-12);
  Eigen::MatrixXd B;
  basis_shapes(model, scene, memory.window, B);
  EXPECT_EQ(record.control.torque.value, B * memory.now);
}

}  // namespace hagfish::reduced_basis_test
