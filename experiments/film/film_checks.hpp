// What no body can do, found in a film and taken out of it or told.
#pragma once

#include <string>
#include <vector>

#include "experiments/film/film.hpp"

namespace hagfish {

/// What was found, a line each, without the file's name.
struct FilmRemarks {
  std::vector<std::string> told;    ///< put right
  std::vector<std::string> doubts;  ///< left, and to be looked at
};

/// Takes out of `film` points at 0,0 that are lost ones, points farther from others than the body
/// between them is long, and midlines that repeat the one before while the animal moves on; turns
/// midlines round whose head and tail are exchanged. Tells also of gaps in time, of jumps of the
/// whole body, of a film that ends with one midline repeated and, in two dimensions, of midlines
/// that cross themselves.
FilmRemarks tidy(Film& film);

/// Takes out of `film` what comes after `until` (s); 0: nothing.
void end_at(Film& film, double until);

/// The value at the place `share` (0 to 1) of `values`, sorted; there must be one.
double quantile_of(std::vector<double> values, double share);

/// Median time from one midline to the next, s.
double usual_interval(const Film& film);

/// Throws InputError, without the file's name, where the film's clock jumps: a step in time of a
/// thousand usual ones and more, which nobody filmed.
void refuse_jumps(const Film& film);

/// Intervals without midlines, [from, to], s of the film: far longer than from one to the next.
std::vector<std::pair<double, double>> gaps(const Film& film);

/// "3.05, 3.1, 3.15 and 12 more", s.
std::string times_text(const std::vector<double>& times);

}  // namespace hagfish
