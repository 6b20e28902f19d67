#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "experiments/common/text_file.hpp"
#include "experiments/mujoco/frame_picture.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

struct PictureOptions {
  std::string log;
  std::string out;  ///< PNG to write; numbered where there are several times
  bool force = false;
  std::vector<double> times;   ///< s; the last frame where empty
  std::string size;            ///< of every picture; that of what each shows where empty
  std::string colour;          ///< quantity of the body; its own colour where empty
  double pitch = usual_pitch;  ///< of the view, degrees; see turned_view in picture.hpp
  double yaw = usual_yaw;      ///< degrees
};

/// OUT.png for one picture, OUT_1.png, OUT_2.png... for several, with as many digits as the last.
fs::path numbered(const fs::path& out, std::size_t index, std::size_t count) {
  if (count == 1) return out;
  const std::size_t digits = std::to_string(count).size();
  return out.parent_path() / fmt::format("{}_{:0{}}{}", out.stem().string(), index + 1, digits,
                                         out.extension().string());
}

/// A window for each frame; where a size is given, one for all.
std::vector<View> views_of(const FramePictures& pictures, const std::vector<std::size_t>& frames,
                           const std::string& size) {
  std::vector<View> views(frames.size(), pictures.view());
  Shown all;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    Shown own;
    pictures.add(frames[k], own);
    pictures.fit(own, std::nullopt, views[k]);
    all.low = all.low.min(own.low);
    all.high = all.high.max(own.high);
  }
  if (!size.empty()) {
    for (View& view : views) pictures.fit(all, picture_size(size, "--size"), view);
  }
  return views;
}

/// Prints a table: for each picture its file, time, lower left corner and scale.
int picture(const PictureOptions& options) {
  const LogContents log(options.log, LogLevel::frames);
  std::vector<std::size_t> frames;
  for (const double time : options.times) frames.push_back(frame_at(log, time));
  if (frames.empty()) frames.push_back(log.time.size() - 1);
  const fs::path out = options.out;
  if (out.extension() != ".png") throw InputError(options.out + ": --out must end in .png");
  const FramePictures pictures(log, options.pitch, options.yaw, options.colour);
  const std::vector<View> views = views_of(pictures, frames, options.size);

  std::vector<std::unique_ptr<OutputFile>> files;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    files.push_back(
        std::make_unique<OutputFile>(numbered(out, k, frames.size()), replaced_if(options.force)));
  }

  PictureSize largest;
  for (const View& view : views) {
    largest.width = std::max(largest.width, view.width);
    largest.height = std::max(largest.height, view.height);
  }
  const auto renderer = pictures.renderer(largest, {});
  std::string table = "file\ttime_s\tleft_cm\tbottom_cm\tcm_per_pixel\n";
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const fs::path file = numbered(out, k, frames.size());
    const Image picture = pictures.draw(*renderer, frames[k], views[k]);
    try {
      write_png(picture, files[k]->partial());
    } catch (const FileError& error) {
      throw WriteError(error.what());
    }
    files[k]->publish();
    table +=
        fmt::format("{}\t{:.9g}\t{:.6f}\t{:.6f}\t{:.6f}\n", printable(file.string()),
                    log.time[frames[k]], views[k].low.x(), views[k].low.y(), 1 / views[k].scale);
  }
  fmt::print("{}", table);
  return exit_code::done;
}

}  // namespace

void add_picture(Program& program) {
  const auto options = std::make_shared<PictureOptions>();
  CLI::App* picture_app = program.app.add_subcommand("picture", "draw frames of a log as PNG");
  picture_app->add_option("LOG", options->log, "log file")->required();
  picture_app->add_option("--out", options->out, "PNG to write; F_1.png, ... for several times")
      ->required();
  picture_app->add_option("--time", options->times, "s, repeatable (the last frame)")
      ->allow_extra_args(false);
  picture_app->add_option("--size", options->size,
                          "WIDTHxHEIGHT, px, one window for all (80 px/cm about what each shows)");
  picture_app
      ->add_option("--colour", options->colour, "colour the body by a quantity (its own colour)")
      ->check(one_of(body_quantity_names()));
  picture_app->add_option("--pitch", options->pitch, "turn of the view about X, degrees")
      ->capture_default_str();
  picture_app->add_option("--yaw", options->yaw, "turn of the view about its vertical, degrees")
      ->capture_default_str();
  picture_app->add_flag("--force", options->force, force_help);
  picture_app->callback([options, &program] { program.code = picture(*options); });
}

}  // namespace hagfish
