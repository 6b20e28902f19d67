#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/chain/kinematics.hpp"
#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/knot/knot.hpp"
#include "experiments/common/csv.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/film/film_checks.hpp"
#include "experiments/film/film_distance.hpp"
#include "experiments/film/film_trial.hpp"
#include "experiments/film/fit/film_curve.hpp"
#include "experiments/program/film_words.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scripts.hpp"

namespace hagfish {
namespace {

struct AgainstOptions {
  std::string log, film, csv, png;
  FilmReading reading;
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

/// Says so where film and log show one knot of two hands at the last time that both have.
void compare_hands(const LogContents& log, const Film& film, double later,
                   const AgainstOptions& options) {
  const auto after = [&](const FilmFrame& frame) { return frame.time + later > log.time.back(); };
  const auto end = std::ranges::find_if(film.frames, after);
  if (end == film.frames.begin()) return;
  const FilmFrame& last = *(end - 1);
  const auto near = std::ranges::lower_bound(log.time, last.time + later) - log.time.begin();
  const auto frame = std::min<Eigen::Index>(near, log.q.rows() - 1);
  Kinematics kin;
  update_positions(log.model, log.q.row(frame).transpose(), kin);
  const KnotSettings& settings = log.resolved.scene.knot;
  const FilmedKnot own = knot_of(kin.centre, settings),
                   seen = knot_of(curve_through(last), settings);
  if (own.name != seen.name || own.hand == seen.hand || own.hand == Hand::any ||
      seen.hand == Hand::any) {
    return;
  }
  fmt::print(
      "{}: at {:g} s its {} is {}-handed, but that of {} is {}-handed: check the "
      "direction of y (--y-up, --y-down)\n",
      printable(options.film), last.time, knot_words(seen.name),
      seen.hand == Hand::right ? "right" : "left", printable(options.log),
      own.hand == Hand::right ? "right" : "left");
}

int against(const AgainstOptions& options) {
  std::optional<TextFile> csv;
  if (!options.csv.empty()) csv.emplace(options.csv, options.force);
  const LogContents log(options.log, LogLevel::frames);
  Film film = read_film(options.film, options.reading);
  const FilmRemarks remarks = tidy(film);
  if (film.frames.empty()) throw InputError(options.film + ": has no midline that can be used");
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
  for (const std::vector<std::string>& lines : {remarks.told, remarks.doubts}) {
    for (const std::string& line : lines) fmt::print("{}: {}\n", printable(options.film), line);
  }
  if (film.planar) {
    fmt::print("{}: has no z: one camera does not show how far apart strands are\n",
               printable(options.film));
  } else {
    compare_hands(log, film, later, options);
  }
  return exit_code::done;
}

}  // namespace

void add_against(Program& program) {
  const auto options = std::make_shared<AgainstOptions>();
  CLI::App* app = program.app.add_subcommand(
      "against", "say how far a run is from midlines digitised from a film");
  app->add_option("LOG", options->log, "log file")->required();
  app->add_option("FILM", options->film, "midlines, as `hagfish midlines` takes them")->required();
  add_film_options(*app, options->reading);
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
