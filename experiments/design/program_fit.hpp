// Curvature programs from the shapes that a body has taken: how a knot found by leading the tail
// becomes one that the animal ties itself.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/chain/model.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// A program and how far its shapes are from those that it was made from, over all hinges and
/// times, rad.
struct ProgramFit {
  CurvatureProgram program;
  double rms_error = 0, largest_error = 0;
  double rms_angle = 0;  ///< rms of the hinges' angles, to compare with
};

/// So many numbers from 0 to `last`, two or more.
std::vector<double> even(int count, double last);

/// The program of `times` from 0 to time.back() and `stations` from 0 to 1, both even, whose shapes
/// are nearest to `q` (frames x nq) at `time` (s, rising, the first 0), by least squares of the
/// hinges' angles. Throws std::invalid_argument for fewer than two of either, or for more than the
/// frames or the joints of a kind can tell.
ProgramFit fit_program(const Model& model, const std::vector<double>& time,
                       const Eigen::MatrixXd& q, int times, int stations);

}  // namespace hagfish
