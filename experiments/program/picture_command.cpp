#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/run/controller.hpp"
#include "experiments/audit/log_contents.hpp"
#include "experiments/program/commands.hpp"
#include "experiments/program/picture.hpp"
#include "experiments/program/text_file.hpp"
#include "mujoco_ref/log_model.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

struct PictureOptions {
  std::string log;
  std::string out;  ///< PNG to write; numbered where there are several times
  bool force = false;
  std::vector<double> times;  ///< s; the last frame where empty
  double pitch = -70;         ///< of the view, degrees; see view_of in picture.hpp
  double yaw = 22;            ///< degrees
};

/// The frame whose time is nearest. Throws InputError outside the log.
std::size_t frame_at(const LogContents& log, double time) {
  if (!(time >= log.time.front() && time <= log.time.back())) {
    throw InputError(fmt::format("{}: --time {:g}: the log runs from {:g} to {:g} s", log.h5.file(),
                                 time, log.time.front(), log.time.back()));
  }
  const auto after = std::lower_bound(log.time.begin(), log.time.end(), time);
  const auto frame = static_cast<std::size_t>(after - log.time.begin());
  return frame > 0 && time - log.time[frame - 1] < *after - time ? frame - 1 : frame;
}

/// What stands in the picture of one frame, with the bodies where MuJoCo puts them.
std::vector<mjvGeom> geoms_of(const LogContents& log, std::size_t frame, MujocoModel& mirror) {
  const auto row = log.q.row(static_cast<Eigen::Index>(frame));
  std::copy(row.begin(), row.end(), mirror.data()->qpos);
  mj_kinematics(mirror.model(), mirror.data());
  // MuJoCo's first body is the world.
  const Eigen::Map<const Eigen::Matrix3Xd> centre(mirror.data()->xipos + 3, 3,
                                                  log.model.body_count());
  std::vector<mjvGeom> geoms = skin_geoms(log.model, log.resolved.specimen, centre);
  const Scene& scene = log.resolved.scene;
  if (scene.wall.present) {
    geoms.push_back(plate_geom(clamps_head(scene, static_cast<Phase>(log.phase[frame]))));
  }
  return geoms;
}

/// OUT.png for one picture, OUT_1.png, OUT_2.png... for several.
fs::path numbered(const fs::path& out, std::size_t index, std::size_t count) {
  if (count == 1) return out;
  return out.parent_path() /
         fmt::format("{}_{}{}", out.stem().string(), index + 1, out.extension().string());
}

/// Prints a table: for each picture its file, time, lower left corner and scale.
int picture(const PictureOptions& options) {
  const LogContents log(options.log);
  std::vector<std::size_t> frames;
  for (const double time : options.times) frames.push_back(frame_at(log, time));
  if (frames.empty()) frames.push_back(log.time.size() - 1);
  const fs::path out = options.out;
  if (out.extension() != ".png") throw InputError(options.out + ": --out must end in .png");
  for (const auto& [name, angle] : {std::pair{"--pitch", options.pitch}, {"--yaw", options.yaw}}) {
    if (!std::isfinite(angle)) throw InputError(fmt::format("{} {}: must be finite", name, angle));
  }

  std::vector<std::unique_ptr<OutputFile>> files;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    files.push_back(
        std::make_unique<OutputFile>(numbered(out, k, frames.size()), replaced_if(options.force)));
  }

  MujocoModel mirror = mujoco_model_of(log.h5);
  if (mirror.model()->nq != log.q.cols() || mirror.model()->nbody != log.model.body_count() + 1) {
    throw FileError(log.h5.file() + ": /mjcf is not the model of /trajectory");
  }
  std::vector<std::vector<mjvGeom>> geoms;
  std::vector<View> views;
  int width = 0, height = 0;
  for (const std::size_t frame : frames) {
    geoms.push_back(geoms_of(log, frame, mirror));
    views.push_back(view_of(geoms.back(), options.pitch, options.yaw));
    width = std::max(width, views.back().width);
    height = std::max(height, views.back().height);
  }
  OffscreenRenderer renderer(*mirror.model(), width, height);
  std::string table = "file\ttime_s\tleft_cm\tbottom_cm\tcm_per_pixel\n";
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const fs::path file = numbered(out, k, frames.size());
    write_png(renderer.render(geoms[k], views[k]), files[k]->partial());
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
  picture_app->add_option("--pitch", options->pitch, "turn of the view about X, degrees")
      ->capture_default_str();
  picture_app->add_option("--yaw", options->yaw, "turn of the view about its vertical, degrees")
      ->capture_default_str();
  picture_app->add_flag("--force", options->force, force_help);
  picture_app->callback([options, &program] { program.code = picture(*options); });
}

}  // namespace hagfish
