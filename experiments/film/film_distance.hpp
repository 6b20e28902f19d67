// How far a run is from a film, point by point.
#pragma once

#include <vector>

#include "core/log/reading/log_contents.hpp"
#include "experiments/film/film.hpp"

namespace hagfish {

struct FilmDistance {
  std::vector<double> time;  ///< times of the frames in both log and film, on the log's clock, s
  std::vector<std::vector<double>> arc;     ///< arc of each point of each, cm of the log's animal
  std::vector<std::vector<double>> off;     ///< its distance from the animal's midline there, cm
  double scale = 1;                         ///< what the film's lengths were multiplied by
  double rms() const;                       ///< rms of all points, cm
  std::vector<double> rms_by_time() const;  ///< cm
};

/// How a film is brought to a log before they are compared.
struct FilmPlacing {
  /// The film's animal is scaled to the length of the log's, as it may be another one, and the film
  /// as a whole moved by the rigid motion that makes the sum of squares least, as it has its own
  /// axes. Where the film does not know its animal's length, the scale makes it least, too. Else a
  /// point is where its s says, in cm, and axes are the log's.
  bool aligned = true;
  double later = 0;  ///< the log's clock minus the film's, s
};

/// Distances from the log's shape, linear between its frames, at each time of the film. Throws
/// InputError where they have no time in common, and where a film whose points have no s is not to
/// be scaled.
FilmDistance film_distance(const LogContents& log, const Film& film, const FilmPlacing& placing);

}  // namespace hagfish
