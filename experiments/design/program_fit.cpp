#include "experiments/design/program_fit.hpp"

#include <cmath>
#include <stdexcept>

#include "core/muscle/active_curvature.hpp"

namespace hagfish {
namespace {

/// What each hinge (rows) takes of 1 rad per body length at each station (columns).
Eigen::MatrixXd station_shares(const Model& model, const std::vector<double>& stations) {
  const auto count = static_cast<Eigen::Index>(stations.size());
  Eigen::MatrixXd shares(model.nv() - root_dofs, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    CurvatureProgram unit{{0}, stations, {Eigen::Matrix3Xd::Zero(3, count)}, {}};
    unit.value[0].col(j).setOnes();
    shares.col(j) = program_shape(model, unit, 0).tail(shares.rows());
  }
  return shares;
}

/// The share of each knot in time (columns) at each frame (rows).
Eigen::MatrixXd time_shares(const Model& model, const std::vector<double>& frames,
                            const std::vector<double>& times) {
  const CurvatureProgram one{{0}, {0}, {Eigen::Matrix3Xd::Ones(3, 1)}, {}};
  const double whole = program_shape(model, one, 0)[root_dofs];
  CurvatureProgram unit{
      times, {0}, std::vector<Eigen::Matrix3Xd>(times.size(), Eigen::Matrix3Xd::Zero(3, 1)), {}};
  Eigen::MatrixXd shares(static_cast<Eigen::Index>(frames.size()),
                         static_cast<Eigen::Index>(times.size()));
  for (Eigen::Index k = 0; k < shares.cols(); ++k) {
    unit.value[k].setOnes();
    for (Eigen::Index f = 0; f < shares.rows(); ++f) {
      shares(f, k) = program_shape(model, unit, frames[f])[root_dofs] / whole;
    }
    unit.value[k].setZero();
  }
  return shares;
}

}  // namespace

std::vector<double> even(int count, double last) {
  std::vector<double> values(count);
  for (int k = 0; k < count; ++k) values[k] = last * k / (count - 1);
  return values;
}

ProgramFit fit_program(const Model& model, const std::vector<double>& time,
                       const Eigen::MatrixXd& q, int times, int stations) {
  const auto frames = static_cast<Eigen::Index>(time.size());
  if (times < 2 || times > frames || stations < 2 || stations > model.body_count() / 4) {
    throw std::invalid_argument(
        "2 times to as many as frames, 2 stations to a quarter of the bodies");
  }
  ProgramFit fit;
  CurvatureProgram& program = fit.program;
  program.time = even(times, time.back());
  program.station = even(stations, 1);
  program.value.assign(times, Eigen::Matrix3Xd::Zero(3, stations));
  // The least squares of a product of shares is that of the one, then that of the other.
  const auto in_time = time_shares(model, time, program.time).colPivHouseholderQr();
  const Eigen::MatrixXd along = station_shares(model, program.station);
  const auto hinges = static_cast<Eigen::Index>(model.hinges.size());
  for (const Axis axis : {Axis::y, Axis::z, Axis::x}) {
    std::vector<Eigen::Index> about;
    for (Eigen::Index k = 0; k < hinges; ++k) {
      if (model.hinges[k].axis == axis) about.push_back(k);
    }
    const Eigen::MatrixXd angles = q.rightCols(hinges)(Eigen::all, about);
    const Eigen::MatrixXd at_times = in_time.solve(angles);  // times x hinges
    const Eigen::MatrixXd values =
        along(about, Eigen::all).colPivHouseholderQr().solve(at_times.transpose());
    for (int k = 0; k < times; ++k) {
      program.value[k].row((static_cast<int>(axis) + 2) % 3) = values.col(k).transpose();
    }
  }
  for (Eigen::Index f = 0; f < frames; ++f) {
    const Eigen::VectorXd angles = q.row(f).tail(hinges).transpose();
    const Eigen::VectorXd off = program_shape(model, program, time[f]).tail(hinges) - angles;
    fit.rms_error += off.squaredNorm();
    fit.rms_angle += angles.squaredNorm();
    fit.largest_error = std::max(fit.largest_error, off.lpNorm<Eigen::Infinity>());
  }
  const auto count = static_cast<double>(frames * hinges);
  fit.rms_error = std::sqrt(fit.rms_error / count);
  fit.rms_angle = std::sqrt(fit.rms_angle / count);
  return fit;
}

}  // namespace hagfish
