// A curvature program whose shapes are those of a film: how an animal that was filmed ties its
// knot.
#pragma once

#include <vector>

#include "core/chain/model.hpp"
#include "experiments/film/film.hpp"

namespace hagfish {

struct FilmFit {
  CurvatureProgram program;
  double rms = 0;  ///< distance of the film's points from the program's shapes, cm of the model
  std::vector<double> rms_at;  ///< the same of each frame
};

/// What the film's axes are: where the head is and how it is turned.
enum class FilmHead {
  still,  ///< the same all through the film: it is clamped
  free    ///< anything at each time, so that nothing is known of how the animal rolls
};

/// The program of `times` from 0 to the film's last time and `stations` from 0 to 1, both even,
/// whose shapes lie nearest to the film's points, by least squares of their distances. Twist, of
/// which a midline says nothing, is 0. Few times and stations are what smooths; besides, second
/// differences along the body are held down by a weight that matters only where the points do not
/// tell, as at the ends. Found by following the film from its first frame, which may not be
/// knotted, and then by Gauss-Newton of all values together. Throws std::invalid_argument as
/// fit_program().
FilmFit fit_film(const Model& model, const Film& film, FilmHead head, int times, int stations);

}  // namespace hagfish
