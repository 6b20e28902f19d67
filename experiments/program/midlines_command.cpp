#include <fmt/format.h>

#include <algorithm>

#include "core/input/curvature_csv.hpp"
#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "experiments/film/film_fit.hpp"
#include "experiments/program/film_words.hpp"
#include "experiments/program/number_options.hpp"
#include "experiments/program/program.hpp"
#include "experiments/program/scene_argument.hpp"
#include "experiments/program/shell_word.hpp"
#include "experiments/program/text_file.hpp"

namespace hagfish {
namespace {

struct MidlinesOptions {
  std::string film, out;
  std::string scene = "living_overhand";  ///< whose animal it is for
  double scale = 0;                       ///< of pixels, px/cm
  double until = 0;                       ///< s; 0: to the film's end
  int stations = 20, times = 24;
  bool free_head = false, force = false;
};

int midlines(const MidlinesOptions& options) {
  TextFile out(options.out, options.force);
  const ResolvedScene resolved = scene_argument(options.scene, {});
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  Film film = read_film(options.film, options.scale);
  if (options.until > 0) {
    std::erase_if(film.frames, [&](const FilmFrame& f) { return f.time > options.until; });
  }
  const auto frames = static_cast<int>(film.frames.size());
  if (options.times > frames) {
    throw InputError(fmt::format(
        "{}: has {} midlines{}, of which --times {} cannot be told", options.film, frames,
        options.until > 0 ? fmt::format(" up to {:g} s", options.until) : "", options.times));
  }
  if (const int most = model.body_count() / 4; options.stations > most) {
    throw InputError(fmt::format("--stations {}: an animal of {} bodies has {} at most",
                                 options.stations, model.body_count(), most));
  }
  const FilmFit fit = fit_film(model, film, options.free_head ? FilmHead::free : FilmHead::still,
                               options.times, options.stations);
  if (fit.rms_at.empty()) {
    throw InputError(options.film + ": no shape can be computed from its numbers");
  }
  out.write(curvature_csv(fit.program));
  const auto worst = std::ranges::max_element(fit.rms_at);
  fmt::print(
      "{}: {} stations x {} times, {:g} s, linear in between, which smooths; {} "
      "midlines of {}{} lie {:.2g} cm from it (rms), the worst, at {:g} s of the film, {:.2g} cm\n",
      printable(options.out), options.stations, options.times, fit.program.time.back(), frames,
      film.planar ? "two dimensions" : "three dimensions",
      scaled(film, model.length() / film.length), fit.rms,
      film.frames[static_cast<std::size_t>(worst - fit.rms_at.begin())].time, *worst);
  if (film.planar) fmt::print("{}", flat_note(options.film));
  fmt::print(
      "hagfish run {} --set script.program={} --set controller.tighten_from={:g} --until form "
      "--out mine.h5\n",
      shell_word(options.scene), shell_word(options.out), fit.program.time.back());
  fmt::print("hagfish against mine.h5 {} --start 0\n", shell_word(options.film));
  return exit_code::done;
}

}  // namespace

void add_midlines(Program& program) {
  const auto options = std::make_shared<MidlinesOptions>();
  CLI::App* app = program.app.add_subcommand(
      "midlines", "make a curvature program from midlines digitised from a film");
  app->add_option("CSV", options->film,
                  "columns time_s, s_cm or point, x_cm, y_cm, perhaps z_cm (or _mm, _m, _px)")
      ->required();
  app->add_option("--out", options->out, "CSV file to write")->required();
  app->add_option("--scene", options->scene, "whose animal it is for: " + std::string(scene_help))
      ->capture_default_str();
  app->add_option("--scale", options->scale, "pixels in a cm, for columns in px")
      ->check(above_zero());
  app->add_option("--until", options->until, "s; where not given, to the end of the film")
      ->check(above_zero());
  app->add_option("--stations", options->stations, "along the body")
      ->check(from_to(2, 100))
      ->capture_default_str();
  app->add_option("--times", options->times, "from the film's first midline to its last")
      ->check(from_to(2, 1000))
      ->capture_default_str();
  app->add_flag("--free-head", options->free_head,
                "the film's head moves; else it is clamped, at one place and turned one way");
  app->add_flag("--force", options->force, force_help);
  app->callback([options, &program] { program.code = midlines(*options); });
}

}  // namespace hagfish
