#include "experiments/program/film_words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/input/input_text.hpp"
#include "experiments/program/number_options.hpp"
#include "experiments/program/shell_word.hpp"

namespace hagfish {

void add_film_options(CLI::App& command, FilmReading& reading) {
  command.add_option("--scale", reading.pixels_per_cm, "pixels in a cm, for columns in px")
      ->check(above_zero());
  command.add_option("--fps", reading.fps, "frames a second, for films that count frames")
      ->check(above_zero());
  command
      .add_option("--likelihood", reading.likelihood,
                  "points that the tracker is less sure of are missing")
      ->check(from_to(0, 1))
      ->capture_default_str();
  command
      .add_option("--animal-length", reading.length,
                  "of the film's animal, cm; where not given, its last s is its tail")
      ->check(above_zero());
  command.add_option("--individual", reading.individual, "which animal of a film of several");
  const auto up = command.add_flag("--y-up", reading.y_up,
                                   "y of columns in px runs up; else down, as rows of images do");
  command.add_flag("--y-down", reading.y_down, "y of columns in cm, mm or m runs down; else up")
      ->excludes(up);
}

std::string film_option_words(const FilmReading& reading) {
  const FilmReading usual;
  std::string words;
  if (reading.pixels_per_cm > 0) words += fmt::format(" --scale {:g}", reading.pixels_per_cm);
  if (reading.fps > 0) words += fmt::format(" --fps {:g}", reading.fps);
  if (reading.likelihood != usual.likelihood) {
    words += fmt::format(" --likelihood {:g}", reading.likelihood);
  }
  if (reading.length > 0) words += fmt::format(" --animal-length {:g}", reading.length);
  if (!reading.individual.empty()) words += " --individual " + shell_word(reading.individual);
  if (reading.y_up) words += " --y-up";
  if (reading.y_down) words += " --y-down";
  return words;
}

std::string scaled(const Film& film, double scale) {
  constexpr double same = 1e-3;
  return std::abs(scale - 1) < same ? ""
                                    : fmt::format(", its animal of {:.3g} {} scaled to {:.3g} cm",
                                                  film.length, film.unit, scale * film.length);
}

std::string tail_note(const FilmReading& reading, const std::string& scaled) {
  return scaled.empty() || reading.length > 0 ? ""
                                              : "the last point is taken as the tip of the tail: "
                                                "if the film never shows the tip, give "
                                                "s_cm and --animal-length\n";
}

std::string flat_note(const std::string& film) {
  return fmt::format(
      "{}: has no z, so the animal is taken to lie in a plane. One camera shows neither which "
      "strand "
      "is on top nor the hand of a knot: film a knot with two cameras\n",
      printable(film));
}

}  // namespace hagfish
