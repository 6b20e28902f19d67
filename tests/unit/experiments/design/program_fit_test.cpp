// Programs made from shapes.
#include "experiments/design/program_fit.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/muscle/active_curvature.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish::program_fit_test {

/// Frames of 20 ms whose hinges have the program's shapes, the root anywhere.
std::pair<std::vector<double>, Eigen::MatrixXd> shapes(const Model& model,
                                                       const CurvatureProgram& program) {
  std::vector<double> time;
  while (0.02 * static_cast<double>(time.size()) <= program.time.back() + 1e-9) {
    time.push_back(0.02 * static_cast<double>(time.size()));
  }
  Eigen::MatrixXd q = Eigen::MatrixXd::Random(static_cast<int>(time.size()), model.nq());
  for (std::size_t f = 0; f < time.size(); ++f) {
    q.row(static_cast<int>(f)).tail(model.nv() - root_dofs) =
        program_shape(model, program, time[f]).tail(model.nv() - root_dofs).transpose();
  }
  return {time, q};
}

CurvatureProgram random_program(unsigned seed, int times, int stations) {
  Random random(seed);
  CurvatureProgram program;
  for (int k = 0; k < times; ++k) {
    program.time.push_back(0.1 * k);
    Eigen::Matrix3Xd& value = program.value.emplace_back(3, stations);
    for (double& x : value.reshaped()) x = uniform(random, -5, 5);
  }
  for (int j = 0; j < stations; ++j) program.station.push_back(j / (stations - 1.0));
  return program;
}

TEST(ProgramFit, FindsTheProgramThatMadeTheShapes) {
  const Model model = table1_hagfish();
  const CurvatureProgram program = random_program(5, 6, 9);
  const auto [time, q] = shapes(model, program);
  const ProgramFit fit = fit_program(model, time, q, 6, 9);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(fit.program.time[k], program.time[k], 1e-12);
    // The outermost half station is seen by one hinge of each axis: a condition of some 10.
    EXPECT_LT((fit.program.value[k] - program.value[k]).cwiseAbs().maxCoeff(), 1e-10);
  }
  EXPECT_LT(fit.largest_error, 1e-12);
}

TEST(ProgramFit, IsTheNearestAndSaysHowFarItIs) {
  const Model model = table1_hagfish();
  const auto [time, q] = shapes(model, random_program(6, 8, 12));
  const ProgramFit fit = fit_program(model, time, q, 5, 7);
  const auto error = [&](const CurvatureProgram& program) {
    double sum = 0;
    double largest = 0;
    for (std::size_t f = 0; f < time.size(); ++f) {
      const Eigen::VectorXd off = (program_shape(model, program, time[f]).tail(149) -
                                   q.row(static_cast<int>(f)).tail(149).transpose());
      sum += off.squaredNorm();
      largest = std::max(largest, off.lpNorm<Eigen::Infinity>());
    }
    return std::pair(std::sqrt(sum / (149.0 * static_cast<double>(time.size()))), largest);
  };
  const auto [rms, largest] = error(fit.program);
  EXPECT_NEAR(fit.rms_error, rms, 1e-12);
  EXPECT_NEAR(fit.largest_error, largest, 1e-12);
  EXPECT_GT(fit.rms_error, 1e-3);
  EXPECT_LT(fit.rms_error, fit.rms_angle);
  // Any other program is further off: one value changed, at random.
  Random random(7);
  for (int k = 0; k < 20; ++k) {
    CurvatureProgram other = fit.program;
    other.value[random() % 5](static_cast<int>(random() % 3), static_cast<int>(random() % 7)) +=
        random() % 2 == 0 ? 0.1 : -0.1;
    EXPECT_GT(error(other).first, rms);
  }
}

TEST(ProgramFit, RefusesMoreThanTheShapesCanTell) {
  const Model model = table1_hagfish();
  const auto [time, q] = shapes(model, random_program(6, 2, 5));
  EXPECT_THROW(fit_program(model, time, q, 1, 5), std::invalid_argument);
  EXPECT_THROW(fit_program(model, time, q, 50, 5), std::invalid_argument);
  EXPECT_THROW(fit_program(model, time, q, 2, 1), std::invalid_argument);
  EXPECT_THROW(fit_program(model, time, q, 2, 26), std::invalid_argument);
}

}  // namespace hagfish::program_fit_test
