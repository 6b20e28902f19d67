// How far a run is from a film, point by point.
#pragma once

#include <vector>

#include "experiments/audit/log_contents.hpp"
#include "experiments/film/film.hpp"

namespace hagfish {

struct FilmDistance {
  std::vector<double> time;                 ///< of the frames that log and film both have, s
  std::vector<std::vector<double>> arc;     ///< of each point of each, cm of the log's animal
  std::vector<std::vector<double>> off;     ///< its distance from the animal's midline there, cm
  double rms() const;                       ///< of all points, cm
  std::vector<double> rms_by_time() const;  ///< cm
};

/// At each time of the film the log's shape, linear between its frames. With `aligned` the film as
/// a whole is first brought to the log by the rigid motion that makes the sum of squares least, as
/// a film has its own axes. Throws InputError where they have no time in common.
FilmDistance film_distance(const LogContents& log, const Film& film, bool aligned);

}  // namespace hagfish
