// Start of a film's fit: its frames by themselves, and the program through them.
#pragma once

#include <vector>

#include "core/scene/interpolation.hpp"
#include "experiments/film/fit/film_misfit.hpp"

namespace hagfish {

/// What is fitted.
struct FilmUnknowns {
  Eigen::MatrixXd values;      ///< values of ProgramShape x times
  std::vector<FilmPose> pose;  ///< one, or one for each frame
  double scale = 1;            ///< cm of the model in one of the film's lengths
};

/// Place of a frame's time among the program's, `knots`.
Bracket film_place(const Film& film, std::size_t frame, const std::vector<double>& knots);

/// What smooths to begin with, cm^2 of squared distance for 1 (rad per length)^2 of second
/// difference: a millimetre of noise, differences of 10 rad per length.
inline constexpr double first_smoothness = 1e-4;

/// The matrix of the squares of second differences along the body, values x values.
Eigen::MatrixXd along_square(const ProgramShape& shape);

/// Unknowns to begin with: frames by themselves, from the curve through their points; then the
/// program through them. Throws InputError, without the file's name, where no two frames have
/// points enough.
FilmUnknowns begin_fit(const ProgramShape& shape, const Film& film,
                       const std::vector<double>& knots, bool still, double scale);

}  // namespace hagfish
