#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "core/input/csv/curvature_csv.hpp"
#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/knot/knot.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/film/film_trial.hpp"
#include "experiments/film/film_verdict.hpp"
#include "experiments/film/fit/film_fit.hpp"
#include "experiments/program/film_words.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scripts.hpp"
#include "experiments/program/shell_word.hpp"

namespace hagfish {
namespace {

/// Between two times of the program, where not asked for, s; and intervals of the film, at least.
constexpr double program_interval = 0.05, frames_a_time = 1;
constexpr int most_times = 1000;
/// Longer programs are not run to find muscles that follow them, s.
constexpr double longest_trial = 60;
/// Rigidities that are known of hagfish, over the middle of them, which scenes have; the sources
/// are in data/specimens/pacific_hagfish.toml.
constexpr double least_rigidity = 0.15, most_rigidity = 6;
/// Between lines that tell of long work.
constexpr std::chrono::seconds told_each{5};

struct MidlinesOptions {
  std::string film, out, png;
  std::string scene = "living_overhand";  ///< whose animal it is for
  FilmReading reading;
  double until = 0;  ///< s; 0: to the film's end
  int stations = 20, times = 0;
  bool free_head = false, force = false;
};

/// Tells now and then how far long work is.
class Work {
 public:
  template <class... Values>
  void tell(fmt::format_string<Values...> format, Values&&... values) {
    const auto now = std::chrono::steady_clock::now();
    if (now - told_ < told_each) return;
    told_ = now;
    say("{}\n", fmt::format(format, std::forward<Values>(values)...));
  }

 private:
  std::chrono::steady_clock::time_point told_ = std::chrono::steady_clock::now();
};

/// A program's CSV with two more columns, which no reader of programs minds.
std::string csv_with_errors(const FilmFit& fit) {
  std::istringstream lines(curvature_csv(fit.program));
  std::string text, line;
  std::getline(lines, line);
  text = line + ",bend_y error (rad/L),bend_z error (rad/L)\n";
  for (const Eigen::Matrix3Xd& error : fit.error) {
    for (Eigen::Index j = 0; j < error.cols() && std::getline(lines, line); ++j) {
      text += fmt::format("{},{:.3g},{:.3g}\n", line, error(0, j), error(1, j));
    }
  }
  return text;
}

int times_of(const Film& film) {
  const double lasts = film.frames.back().time - film.frames.front().time;
  const double interval = std::max(program_interval, frames_a_time * usual_interval(film));
  return std::clamp(static_cast<int>(std::lround(lasts / interval)) + 1, 2, most_times);
}

/// The scene's file, beside the program's.
std::string scene_file(const MidlinesOptions& options) {
  return std::filesystem::path(options.out).replace_extension(".toml").string();
}

std::string hand_text(const FilmedKnot& knot) {
  return knot.hand == Hand::right  ? ", right-handed"
         : knot.hand == Hand::left ? ", left-handed"
         : knot.name == "0_1"      ? ""
                              : ", which has no hand, so a wrong direction of y would not show";
}

/// A scene file that `hagfish run` takes, of what scene_of_film() changes.
std::string scene_text(const MidlinesOptions& options, const Model& model,
                       const CurvatureProgram& program, const FilmedKnot& knot, double stiffness) {
  namespace fs = std::filesystem;
  const bool file = fs::path(options.scene).extension() == ".toml";
  const auto quoted = [](const std::string& text) { return nlohmann::json(text).dump(); };
  std::string text = fmt::format(
      "# As filmed: {}. Keys: data/table1.toml.\n\nbase = {}\ntitle = \"As filmed\"\n\n[script]\n"
      "kind = \"curvature\"\nprogram = {}\n\n[active]\nstiffness = {:g}\n\n[controller]\n"
      "tighten_from = {:g}\n\n[start]\nbend = [  # station, about x, y, z, rad/cm\n",
      printable(options.film), quoted(file ? fs::absolute(options.scene).string() : options.scene),
      quoted(fs::path(options.out).filename().string()), stiffness, program.time.back());
  for (const Eigen::Vector4d& row : first_bends(model, program)) {
    text += fmt::format("  [{:g}, {:g}, {:g}, {:g}],\n", row[0], row[1], row[2], row[3]);
  }
  text += "]\n";
  if (knot.name != "0_1") {
    text += fmt::format(
        "\n[expect]\nknot = \"{0}\"\nhand = \"{1}\"\ntypes = [[\"{0}\", \"tighten\", "
        "\"release\"]]\n",
        knot.name,
        knot.hand == Hand::right  ? "right"
        : knot.hand == Hand::left ? "left"
                                  : "any");
  }
  return text;
}

/// Says which knot the film ends with, finds muscles that follow the program, and writes the scene.
void run_by(const MidlinesOptions& options, const ResolvedScene& resolved,
            const CurvatureProgram& program, TextFile& out, Work& work) {
  const Model& model = resolved.model;
  const FilmedKnot knot = knot_of(model, program, program.time.size() - 1, resolved.scene.knot);
  fmt::print("knot at the film's end: {}{}\n", knot.name == "0_1" ? "none" : knot_words(knot.name),
             hand_text(knot));
  double stiffness = resolved.scene.active.stiffness;
  if (resolved.scene.script.kind != ScriptSettings::Kind::curvature || !(stiffness > 0)) {
    fmt::print("{}: has no curvature program: choose a scene living_... (see `hagfish scenes`)\n",
               printable(options.scene));
    return;
  }
  const Scene& scene = resolved.scene;
  const std::vector<double>& own = resolved.specimen.bending_stiffness;
  fmt::print(
      "torques are about in proportion to the rigidity EI, here {:g} dyn cm^2: where nobody "
      "measured that animal's, run the film with {:g} and {:g} times it, as far apart as values of "
      "hagfish are, and give each torque's range\n",
      scene.model.passive == PassiveSource::specimen && !own.empty()
          ? own.front()
          : scene.model.bending_stiffness,
      least_rigidity, most_rigidity);
  if (program.time.back() > longest_trial) {
    fmt::print("not run: the program is longer than {:g} s\n", longest_trial);
  } else {
    const std::optional<FilmTrial> best = best_of(
        try_stiffness(resolved, program, knot,
                      [&](const StepRecord& step, const Simulation&) {
                        work.tell("trial run: {:.1f} of {:g} s", step.time, program.time.back());
                      }),
        knot);
    if (best) {
      stiffness = best->stiffness;
      fmt::print(
          "run by this program with active.stiffness = {:g} (a setting found by trying, no "
          "property "
          "of the animal): {:.2g} cm from its shapes (rms), ends with {}{}\n",
          stiffness, best->rms, a_knot(best->knot.name),
          best->knot.name == knot.name && best->knot.hand == knot.hand
              ? ", as the film does"
              : ": muscles of this stiffness or less do not tie the film's knot");
    } else {
      fmt::print("no run by this program reached its end: a smoother film may help\n");
    }
  }
  out.write(scene_text(options, model, program, knot, stiffness));
  fmt::print("hagfish run {} --until form --out mine.h5\n", shell_word(scene_file(options)));
  fmt::print("hagfish against mine.h5 {} --start 0{}\n", shell_word(options.film),
             film_option_words(options.reading));
}

int midlines(const MidlinesOptions& options) {
  TextFile out(options.out, options.force);
  TextFile scene_out(scene_file(options), options.force);
  const ResolvedScene resolved = scene_argument(options.scene, {});
  const Model& model = resolved.model;
  if (const int most = model.body_count() / 4; options.stations > most) {
    throw InputError(fmt::format("--stations {}: an animal of {} bodies can have at most {}",
                                 options.stations, model.body_count(), most));
  }
  Film film = read_film(options.film, options.reading);
  end_at(film, options.until);
  const FilmRemarks remarks = tidy(film);
  if (film.frames.size() < 2) {
    throw InputError(fmt::format(
        "{}: has {} usable midlines{}; two are needed", options.film, film.frames.size(),
        options.until > 0 ? fmt::format(" up to {:g} s", options.until) : ""));
  }
  const int times = options.times > 0 ? options.times : times_of(film);
  const FilmHead head = options.free_head ? FilmHead::free : FilmHead::still;
  FilmFit fit;
  Work work;
  try {
    refuse_jumps(film);
    fit = fit_film(model, film, head, times, options.stations,
                   [&](int step) { work.tell("fit: step {}", step); });
  } catch (const InputError& error) {
    throw InputError(options.film + ": " + error.what());
  }
  if (!std::isfinite(fit.rms) || fit.error.empty()) {
    throw InputError(options.film + ": no shape fits its points: check units and scale");
  }
  const FilmJudgement judgement = judge(model, film, options.reading, remarks, fit, head);
  const std::string scale = scaled(film, fit.scale);
  fmt::print("{}: read as {}, {} midlines of {}{}{}\n{}", printable(options.film), film.format,
             film.frames.size(), film.planar ? "two dimensions" : "three dimensions",
             film.turned.empty() ? "" : ", " + film.turned, scale,
             ends_note(film, options.reading, scale));
  fmt::print("{}", another_animal_note(film, options.reading, options.scene, model, "torques"));
  for (const std::string& told : remarks.told) fmt::print("{}\n", told);
  for (const auto& [from, to] : gaps(film)) {
    fmt::print("no midlines from {:.4g} to {:.4g} s: filled in between\n", from, to);
  }
  fmt::print(
      "{}: {:.2g} cm from {:.3g} % of the points (rms), whose noise is {:.2g} cm a coordinate; the "
      "worst midline, at {:.4g} s, {:.2g} cm\n",
      verdict_name(judgement.verdict), fit.rms, 100 * judgement.share_used, fit.noise,
      judgement.worst_time, judgement.worst);
  for (const std::string& why : judgement.why) fmt::print("look at: {}\n", why);
  if (judgement.verdict == FilmVerdict::failed) return not_fitted;
  const std::string csv = csv_with_errors(fit);
  if (!options.png.empty()) draw_from_text("midlines.py", csv, options.png, options.force);
  out.write(csv);
  fmt::print("{}: {} stations x {} times, {:g} s, linear in between\n", printable(options.out),
             options.stations, times, fit.program.time.back());
  if (film.planar) {
    fmt::print("{}", flat_note(options.film));
    return exit_code::done;
  }
  // As a run reads it, rounded.
  run_by(options, resolved, read_curvature_csv(csv, options.out), scene_out, work);
  return exit_code::done;
}

}  // namespace

void add_midlines(Program& program) {
  const auto options = std::make_shared<MidlinesOptions>();
  CLI::App* app = program.app.add_subcommand(
      "midlines", "make a curvature program from midlines digitised from a film");
  app->add_option("FILM", options->film, film_help)->required();
  app->add_option("--out", options->out, "CSV file to write")->required();
  app->add_option("--scene", options->scene, "whose animal it is for: " + std::string(scene_help))
      ->capture_default_str();
  add_film_options(*app, options->reading);
  app->add_option("--until", options->until, "s; where not given, to the end of the film")
      ->check(above_zero());
  app->add_option("--stations", options->stations, "along the body")
      ->check(from_to(2, 100))
      ->capture_default_str();
  app->add_option("--times", options->times,
                  "from the film's first midline to its last; where not given, one each 0.05 s or "
                  "each midline")
      ->check(from_to(2, most_times));
  app->add_option("--png", options->png, "figure: the program with bands of 90 %");
  app->add_flag("--free-head", options->free_head,
                "the film's head moves; else it is clamped, at one place and turned one way");
  app->add_flag("--force", options->force, force_help);
  app->callback([options, &program] { program.code = midlines(*options); });
}

}  // namespace hagfish
