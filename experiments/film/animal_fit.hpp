// What a film says of its animal's passive body and of the water: found from motion that no muscle
// drives.
#pragma once

#include <array>
#include <functional>

#include "core/input/files/scene_reader.hpp"
#include "experiments/film/film.hpp"
#include "experiments/film/fit/film_fit.hpp"

namespace hagfish {

/// A factor of what the scene has, and its interval of 90 %.
struct TraitEstimate {
  double factor = 1, low = 1, high = 1;
  bool told = false;  ///< whether the film says it: the interval spans less than trait_told
};

struct AnimalFit {
  /// Of bending and twist, and of the water across and along the body.
  enum Trait { stiffness, damping, drag, traits };
  std::array<TraitEstimate, traits> trait;
  double scale = 1;   ///< cm of the model in one of the film's lengths
  double rms = 0;     ///< distance of the film's points from the run, cm of the model
  double shapes = 0;  ///< distance of the same points from fit_film()'s shapes, cm
  double moved = 0;   ///< rms distance of the run's points from where they begin, cm
  /// Whether the last change made less than a ten-thousandth of a difference, or none led nearer.
  bool settled = false;
  /// Whether the run, of a body without muscles, comes about as near to the film as shapes do.
  bool moves_alike = false;
};

/// Highest over lowest value of an interval of 90 % within which a film is said to tell a trait. A
/// film whose body moves by less than it is off tells none.
inline constexpr double trait_told = 4;

/// The factors by which the scene's animal, without muscles, moves most like the film from its
/// first midline on: nonlinear least squares over the logarithms of the factors, the bends and
/// their rates at the start, and of a free head its velocity (Levenberg and Marquardt's steps;
/// rates by differences of runs). The film's axes are those of the nearest rigid motion. Intervals
/// are those of the linear model, with the variance of the residuals. It grows with what neighbours
/// in time have in common. Factors have a prior: a factor of ten is one standard deviation.
/// fit_film() gives the start, the scale, and which points are used. The film's first part is
/// fitted before all of it. The scene has no gravity and no obstacles but the head plate, which is
/// left out. Throws InputError, without the film's name, where it has either, or has no stiffness,
/// damping or drag to scale; and as fit_film(). Calls `watch`, where there is one, at each change
/// with their number so far.
AnimalFit fit_animal(const ResolvedScene& resolved, const Film& film, FilmHead head,
                     const std::function<void(int)>& watch = {});

}  // namespace hagfish
