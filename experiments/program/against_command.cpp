#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/input/input_text.hpp"
#include "experiments/film/film_distance.hpp"
#include "experiments/program/csv.hpp"
#include "experiments/program/film_words.hpp"
#include "experiments/program/number_options.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scripts.hpp"
#include "experiments/program/text_file.hpp"

namespace hagfish {
namespace {

struct AgainstOptions {
  std::string log, film, csv, png;
  double scale = 0;             ///< of pixels, px/cm
  std::optional<double> start;  ///< time of the log at the film's first midline, s
  bool as_is = false, force = false;
};

CsvTable table_of(const FilmDistance& distance) {
  CsvTable table{{"time_s", "s_cm", "distance_cm"}};
  for (std::size_t f = 0; f < distance.time.size(); ++f) {
    for (std::size_t k = 0; k < distance.off[f].size(); ++k) {
      table.push_back({fmt::format("{:.9g}", distance.time[f]),
                       fmt::format("{:.6g}", distance.arc[f][k]),
                       fmt::format("{:.6g}", distance.off[f][k])});
    }
  }
  return table;
}

int against(const AgainstOptions& options) {
  std::optional<TextFile> csv;
  if (!options.csv.empty()) csv.emplace(options.csv, options.force);
  const LogContents log(options.log, LogLevel::frames);
  const Film film = read_film(options.film, options.scale);
  const double later = options.start ? *options.start - film.frames.front().time : 0;
  const FilmDistance distance = film_distance(log, film, {!options.as_is, later});
  const std::vector<double> by_time = distance.rms_by_time();
  const auto worst = std::ranges::max_element(by_time) - by_time.begin();
  const std::string text = csv_text(table_of(distance));
  if (!options.png.empty()) draw_from_text("against.py", text, options.png, options.force);
  if (csv) csv->write(text);
  fmt::print(
      "{}: {:.3g} cm from {} (rms of {} of its {} midlines{}{}); the worst, at {:g} s, {:.3g} cm\n",
      printable(options.log), distance.rms(), printable(options.film), by_time.size(),
      film.frames.size(), options.as_is ? "" : ", the film moved as a whole",
      scaled(film, distance.scale), distance.time[worst], by_time[worst]);
  if (film.planar) fmt::print("{}", flat_note(options.film));
  return exit_code::done;
}

}  // namespace

void add_against(Program& program) {
  const auto options = std::make_shared<AgainstOptions>();
  CLI::App* app = program.app.add_subcommand(
      "against", "say how far a run is from midlines digitised from a film");
  app->add_option("LOG", options->log, "log file")->required();
  app->add_option("CSV", options->film, "midlines, as `hagfish midlines` takes them")->required();
  app->add_option("--scale", options->scale, "pixels in a cm, for columns in px")
      ->check(above_zero());
  app->add_flag("--as-is", options->as_is,
                "the film's axes and animal are the log's: neither move nor scale it");
  app->add_option("--start", options->start,
                  "time of the log at the film's first midline, s; where not given, both have one "
                  "clock");
  app->add_option("--csv", options->csv, "file for every distance: time, arc length, distance");
  app->add_option("--png", options->png, "figure: distance by time and along the body");
  app->add_flag("--force", options->force, force_help);
  app->callback([options, &program] { program.code = against(*options); });
}

}  // namespace hagfish
