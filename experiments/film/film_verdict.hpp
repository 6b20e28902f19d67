// Whether the fit of a film can be used.
#pragma once

#include <string>
#include <vector>

#include "core/chain/model.hpp"
#include "experiments/film/film_checks.hpp"
#include "experiments/film/fit/film_fit.hpp"

namespace hagfish {

enum class FilmVerdict {
  fitted,    ///< can be used
  doubtful,  ///< can be used by who has looked at what is told
  failed     ///< cannot be used: it is not the film's animal
};

struct FilmJudgement {
  FilmVerdict verdict = FilmVerdict::fitted;
  std::vector<std::string> why;      ///< a line each; none where it is fitted
  double share_used = 0;             ///< share of the points that the film should have
  double worst = 0, worst_time = 0;  ///< midline: rms, cm of the model, and when, s of the film
};

/// `film` as it was read and fitted, `remarks` what was taken out of it before.
FilmJudgement judge(const Model& model, const Film& film, const FilmReading& reading,
                    const FilmRemarks& remarks, const FilmFit& fit, FilmHead head);

/// Length of the film's animal, cm: by its s, as told, or as far as its points reach. 0 where
/// nothing says the size of its px.
double animal_length(const Film& film, const FilmReading& reading);

/// "fitted", "doubtful", "failed".
const char* verdict_name(FilmVerdict verdict);

}  // namespace hagfish
