#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/knot/knot.hpp"
#include "core/log/hdf5/output_file.hpp"
#include "experiments/common/terminal.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/judge/replay.hpp"
#include "experiments/mujoco/encoder.hpp"
#include "experiments/mujoco/frame_picture.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

constexpr double pictures_a_second = 25;
constexpr double rounding = 1e-6;               // of a number of pictures
constexpr double gif_pictures_a_second = 12.5;  // what takes palettes by the frame is large
// One shadow, from a map of half the size: a third of the time.
constexpr PictureQuality film_quality{1, 2048};
constexpr std::size_t window_frames = 200;  // that tell what the whole film must show, at least

struct MovieOptions {
  std::string log;
  std::string out;
  std::string size = "1280x720";
  double speed = 1;            ///< simulated seconds a second of film
  std::string colour;          ///< quantity of the body; its own colour where empty
  double pitch = usual_pitch;  ///< of the view, degrees; see turned_view in picture.hpp
  double yaw = usual_yaw;      ///< degrees
  bool force = false, quiet = false;
};

/// Frames of the log at the pictures of a film.
std::vector<std::size_t> film_frames(const LogContents& log, double rate, double speed) {
  std::vector<std::size_t> frames;
  const double seconds = (log.time.back() - log.time.front()) / speed;
  const double count = std::floor(seconds * rate + rounding) + 1;
  constexpr double most = 1e6;
  if (count > most) {
    throw InputError(fmt::format("--speed {:g}: makes {:.3g} pictures; at most {:g} are allowed",
                                 speed, count, most));
  }
  for (int k = 0; k < static_cast<int>(count); ++k) {
    frames.push_back(frame_at(log, std::min(log.time.front() + k * speed / rate, log.time.back())));
  }
  return frames;
}

std::string words_of(const LogContents& log, const KnotInvariants& type, std::size_t frame) {
  return fmt::format("t = {:.2f} s   {}   {}", log.time[frame],
                     phase_name(static_cast<Phase>(log.phase[frame])), knot_words(type));
}

int movie(const MovieOptions& options) {
  const FilmFormat format = film_format(options.out);
  const PictureSize size = picture_size(options.size, "--size");
  if (format == FilmFormat::mp4 && (size.width % 2 != 0 || size.height % 2 != 0)) {
    throw InputError("--size " + options.size + ": width and height of an MP4 must be even");
  }
  require_ffmpeg();
  const LogContents log(options.log, LogLevel::frames);
  const double rate = format == FilmFormat::gif ? gif_pictures_a_second : pictures_a_second;
  const std::vector<std::size_t> frames = film_frames(log, rate, options.speed);
  const FramePictures pictures(log, options.pitch, options.yaw, options.colour);
  OutputFile file(options.out, replaced_if(options.force));
  View view = pictures.view();
  Shown shown;
  for (std::size_t k = 0; k < frames.size();
       k += std::max<std::size_t>(1, frames.size() / window_frames)) {
    pictures.add(frames[k], shown);
  }
  pictures.fit(shown, size, view, true);
  const std::vector<KnotInvariants> types = logged_knots(log);
  const bool progress = !options.quiet && ::isatty(::fileno(stderr)) != 0;
  note_signals();
  std::error_code ignored;
  try {
    const auto renderer = pictures.renderer(size, film_quality);
    FilmEncoder film(file.partial(), format, size.width, size.height, rate);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      if (interrupted()) throw std::runtime_error(options.out + ": interrupted");
      const std::string words = words_of(log, types[frames[k]], frames[k]);
      film.add(pictures.draw(*renderer, frames[k], view, words));
      if (progress) say("\r{}: picture {} of {}", printable(options.out), k + 1, frames.size());
    }
    film.finish();
  } catch (...) {
    if (progress) say("\n");
    std::filesystem::remove(file.partial(), ignored);
    throw;
  }
  if (progress) say("\n");
  file.publish();
  fmt::print("{}: {} pictures, {:.1f} s\n", printable(options.out), frames.size(),
             static_cast<double>(frames.size()) / rate);
  return exit_code::done;
}

}  // namespace

void add_movie(Program& program) {
  const auto options = std::make_shared<MovieOptions>();
  CLI::App* app = program.app.add_subcommand("movie", "draw a log as a film, MP4 or GIF");
  app->add_option("LOG", options->log, "log file")->required();
  app->add_option("--out", options->out, "F.mp4 or F.gif to write")->required();
  app->add_option("--size", options->size, "WIDTHxHEIGHT, px")->capture_default_str();
  app->add_option("--speed", options->speed, "simulated seconds a second of film")
      ->check(above_zero())
      ->capture_default_str();
  app->add_option("--colour", options->colour, "colour the body by a quantity (its own colour)")
      ->check(one_of(body_quantity_names()));
  app->add_option("--pitch", options->pitch, "turn of the view about X, degrees")
      ->capture_default_str();
  app->add_option("--yaw", options->yaw, "turn of the view about its vertical, degrees")
      ->capture_default_str();
  app->add_flag("--quiet", options->quiet, "no progress");
  app->add_flag("--force", options->force, force_help);
  app->callback([options, &program] { program.code = movie(*options); });
}

}  // namespace hagfish
