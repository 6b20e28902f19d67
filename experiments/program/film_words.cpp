#include "experiments/program/film_words.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "core/input/input_text.hpp"
#include "experiments/film/film_table.hpp"
#include "experiments/film/film_verdict.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/shell_word.hpp"

namespace hagfish {
void add_film_options(CLI::App& command, FilmReading& reading) {
  const auto scale =
      command.add_option("--scale", reading.pixels_per_cm, "pixels in a cm, for columns in px")
          ->check(above_zero());
  std::map<std::string, double> units;
  std::vector<std::string> names;
  for (const auto& [unit, cm] : length_units) units.emplace(names.emplace_back(unit), cm);
  command
      .add_option_function<std::string>(
          "--unit",
          [&reading, units](const std::string& unit) { reading.unit_cm = units.at(unit); },
          "unit of coordinates that name none, as of points in space: cm, mm or m")
      ->check(one_of(names))
      ->excludes(scale);
  command.add_option("--fps", reading.fps, "frames a second, for films that count frames")
      ->check(above_zero());
  command
      .add_option("--likelihood", reading.likelihood,
                  "points that the tracker is less sure of are missing")
      ->check(from_to(0, 1))
      ->capture_default_str();
  command
      .add_option("--animal-length", reading.length,
                  "of the film's animal, cm; where not given, its last point is its tail")
      ->check(above_zero());
  command
      .add_option("--first-point", reading.first,
                  "way from the tip of the head to the first of numbered points, cm; where not "
                  "given, 0")
      ->check(above_zero());
  command.add_option("--individual", reading.individual, "which animal of a film of several");
  const auto up = command.add_flag("--y-up", reading.y_up,
                                   "y of one camera's columns in px runs up; else down, as rows of "
                                   "images do");
  command.add_flag("--y-down", reading.y_down, "y of all others runs down; else up")->excludes(up);
}

std::string film_option_words(const FilmReading& reading) {
  const FilmReading usual;
  std::string words;
  if (reading.pixels_per_cm > 0) words += fmt::format(" --scale {:g}", reading.pixels_per_cm);
  for (const auto& [unit, cm] : length_units) {
    if (reading.unit_cm == cm) words += fmt::format(" --unit {}", unit);
  }
  if (reading.fps > 0) words += fmt::format(" --fps {:g}", reading.fps);
  if (reading.likelihood != usual.likelihood) {
    words += fmt::format(" --likelihood {:g}", reading.likelihood);
  }
  if (reading.length > 0) words += fmt::format(" --animal-length {:g}", reading.length);
  if (reading.first > 0) words += fmt::format(" --first-point {:g}", reading.first);
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

std::string ends_note(const Film& film, const FilmReading& reading, const std::string& scaled) {
  if (scaled.empty() || reading.length > 0) return "";
  const bool head = !film.length_known && reading.first == 0;
  return fmt::format(
      "{}the last point is taken as the tip of the tail: if the film never shows {}, give "
      "{}--animal-length\n",
      head ? "the first point is taken as the tip of the head, and " : "",
      head ? "them" : "the tip", head ? "--first-point and " : "");
}

std::string another_animal_note(const Film& film, const FilmReading& reading,
                                const std::string& scene, const Model& model, const char* figures) {
  // Of the length: torques of one that differs by more differ by a fifth and more.
  constexpr double same_animal = 0.05;
  const double animal = animal_length(film, reading);
  if (animal == 0 || std::abs(animal / model.length() - 1) <= same_animal) return "";
  return fmt::format(
      "its animal has {:.3g} cm, that of {} {:g} cm: {} will be of the latter; describe yours by "
      "`hagfish specimen` and name the scene that it writes by --scene\n",
      animal, printable(scene), model.length(), figures);
}

std::string flat_note(const std::string& film) {
  return fmt::format(
      "{}: has no z, so the animal is taken to lie in a plane. One camera shows neither which "
      "strand "
      "is on top nor the hand of a knot: film a knot with two cameras\n",
      printable(film));
}

}  // namespace hagfish
