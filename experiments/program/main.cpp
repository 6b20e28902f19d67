// hagfish: runs scenes and reads their logs.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "core/input/input_error.hpp"
#include "core/log/build_info.hpp"
#include "core/log/hdf5_error.hpp"
#include "experiments/program/commands.hpp"
#include "experiments/program/presets.hpp"
#include "solvers/box_qp.hpp"

namespace {

constexpr int bad_input = 2;

std::string joined(int argc, char** argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) {
    text += (i > 0 ? " " : "") + std::string(argv[i]);
  }
  return text;
}

constexpr const char* scene_help = "a built-in scene (see `scenes`) or a TOML file";
constexpr const char* set_help = "override a scene's key: KEY=VALUE, repeatable";

// Each command's options live as long as its callback, which keeps them. `typed` is the command
// line, for files that tell how they were made; `code` becomes the exit code.

void add_run(CLI::App& app, const std::string& typed, int& code) {
  const auto options = std::make_shared<hagfish::RunOptions>();
  options->command = typed;
  CLI::App* run = app.add_subcommand("run", "run a scene and write its log");
  run->add_option("SCENE", options->scene, scene_help)->capture_default_str();
  run->add_option("--out", options->out, "log to write (SCENE.h5)");
  run->add_option("--preset", options->preset,
                  "settings by name: " + hagfish::preset_names() + " (the scene's, and Ipopt)");
  run->add_option("--qp", options->qp, "QP back end, instead of the preset's")
      ->check(CLI::IsMember(hagfish::box_qp_solver_names()));
  run->add_option("--set", options->set, set_help)->allow_extra_args(false);
  run->add_option("--until", options->until,
                  "stop when this phase has ended: form, tighten, slide, reverse, release");
  run->add_flag("--force", options->force, "replace an existing log");
  run->add_flag("--quiet", options->quiet, "no progress");
  run->callback([options, &code] { code = hagfish::run(*options); });
}

void add_record_qp(CLI::App& app, const std::string& typed, int& code) {
  const auto options = std::make_shared<hagfish::RecordQpOptions>();
  options->command = typed;
  CLI::App* record = app.add_subcommand("record-qp", "run a scene and save its QPs");
  record->add_option("SCENE", options->scene, scene_help)->capture_default_str();
  record->add_option("--out", options->out, "HDF5 file to write")->required();
  record->add_option("--qp", options->qp, "QP back end of the run")
      ->check(CLI::IsMember(hagfish::box_qp_solver_names()))
      ->capture_default_str();
  record->add_option("--set", options->set, set_help)->allow_extra_args(false);
  record->add_option("--every", options->every, "steps from one saved to the next")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  record->add_flag("--primal", options->primal, "save {H, g, G, e, C, d}, not {A, b, l, u}");
  record->add_flag("--force", options->force, "replace an existing file");
  record->add_flag("--quiet", options->quiet, "no progress");
  record->callback([options, &code] { code = hagfish::record_qp(*options); });
}

void add_qp(CLI::App& app, int& code) {
  const auto options = std::make_shared<hagfish::QpOptions>();
  CLI::App* qp = app.add_subcommand(
      "qp", "solve a set of QPs with each back end, cold and warm; exits 1 where one fails");
  qp->add_option("SET", options->set, "HDF5 file of QPs")->required();
  qp->add_option("--backend", options->back_ends, "repeatable (all)")
      ->check(CLI::IsMember(hagfish::measured_back_ends()))
      ->allow_extra_args(false);
  qp->add_option("--tolerance", options->tolerances,
                 "of Ipopt's own stopping, repeatable: measures each (1e-9)")
      ->check(CLI::PositiveNumber)
      ->allow_extra_args(false);
  qp->add_option("--repeat", options->repeat, "times that each QP is solved")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  qp->add_option("--csv", options->csv, "file for the table");
  qp->callback([options, &code] { code = hagfish::qp(*options); });
}

void add_log_readers(CLI::App& app, int& code) {
  const auto file = std::make_shared<std::string>();
  CLI::App* info = app.add_subcommand("info", "say what a log holds");
  info->add_option("LOG", *file, "log file")->required();
  info->callback([file, &code] { code = hagfish::info(*file); });
  CLI::App* check = app.add_subcommand("check", "audit a log; exits 1 naming what fails");
  check->add_option("LOG", *file, "log file")->required();
  check->callback([file, &code] { code = hagfish::check(*file); });
}

#ifdef HAGFISH_MUJOCO

void add_picture(CLI::App& app, int& code) {
  const auto options = std::make_shared<hagfish::PictureOptions>();
  CLI::App* picture = app.add_subcommand("picture", "draw frames of a log as PNG");
  picture->add_option("LOG", options->log, "log file")->required();
  picture->add_option("--out", options->out, "PNG to write; F_1.png, ... for several times")
      ->required();
  picture->add_option("--time", options->times, "s, repeatable (the last frame)")
      ->allow_extra_args(false);
  picture->add_option("--pitch", options->pitch, "turn of the view about X, degrees")
      ->capture_default_str();
  picture->add_option("--yaw", options->yaw, "turn of the view about its vertical, degrees")
      ->capture_default_str();
  picture->callback([options, &code] { code = hagfish::picture(*options); });
}

void add_mjcf(CLI::App& app, int& code) {
  const auto options = std::make_shared<hagfish::MjcfOptions>();
  CLI::App* mjcf = app.add_subcommand("mjcf", "write a scene's animal as MJCF, for MuJoCo");
  mjcf->add_option("SCENE", options->scene, scene_help)->capture_default_str();
  mjcf->add_option("--out", options->out, "folder to write to")->required();
  mjcf->add_option("--set", options->set, set_help)->allow_extra_args(false);
  mjcf->add_flag("--clamp", options->clamp, "weld the head to the world");
  mjcf->add_flag("--force", options->force, "replace existing files");
  mjcf->callback([options, &code] { code = hagfish::mjcf(*options); });
}

void add_compare(CLI::App& app, const std::string& typed, int& code) {
  const auto options = std::make_shared<hagfish::CompareOptions>();
  options->command = typed;
  CLI::App* compare = app.add_subcommand(
      "compare", "hold the simulator against MuJoCo; exits 1 where a bound is passed");
  compare->add_option("SCENE", options->scene, scene_help)->capture_default_str();
  compare->add_option("--out", options->out, "HDF5 file to write, for the figure");
  compare->add_option("--set", options->set, set_help)->allow_extra_args(false);
  compare->callback([options, &code] { code = hagfish::compare(*options); });
}

void add_integrate(CLI::App& app, const std::string& typed, int& code) {
  const auto options = std::make_shared<hagfish::IntegrateOptions>();
  options->command = typed;
  CLI::App* integrate = app.add_subcommand(
      "integrate", "error against CPU time along a smooth motion, for the core and MuJoCo");
  integrate->add_option("SCENE", options->scene, scene_help)->capture_default_str();
  integrate->add_option("--motion", options->motion, "coil, hanging or whip")
      ->capture_default_str();
  integrate->add_option("--out", options->out, "HDF5 file to write")->required();
  integrate->add_option("--set", options->set, set_help)->allow_extra_args(false);
  integrate->callback([options, &code] { code = hagfish::integrate(*options); });
}

void add_playback(CLI::App& app, const std::string& typed, int& code) {
  const auto options = std::make_shared<hagfish::PlaybackOptions>();
  options->command = typed;
  CLI::App* playback = app.add_subcommand(
      "playback",
      "slide a log's knot in MuJoCo, with its own contacts, by mean f_thigmo from frame to frame");
  playback->add_option("LOG", options->log, "log whose knot slides")->required();
  playback->add_option("--out", options->out, "HDF5 file to write")->required();
  playback->callback([options, &code] { code = hagfish::playback(*options); });
}

void add_stress(CLI::App& app, int& code) {
  const auto options = std::make_shared<hagfish::StressOptions>();
  CLI::App* stress = app.add_subcommand(
      "stress", "run a scene by one method at one step and name the outcome: a CSV row");
  stress->add_option("SCENE", options->scene, scene_help)->required();
  stress->add_option("--method", options->method, "how the steps are taken")
      ->check(CLI::IsMember(hagfish::stress_methods()))
      ->capture_default_str();
  stress->add_option("--step", options->step, "time step, s (the scene's)")
      ->check(CLI::PositiveNumber);
  stress->add_option("--level", options->level, "what the row calls the scene's level")
      ->capture_default_str();
  stress->add_option("--set", options->set, set_help)->allow_extra_args(false);
  stress->add_option("--cpu-limit", options->cpu_limit, "the run is capped after this, s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  stress->add_option("--out", options->out, "CSV to write (standard output)");
  stress->callback([options, &code] { code = hagfish::stress(*options); });
}

#endif

int dispatch(int argc, char** argv) {
  CLI::App app{"A hagfish that ties itself into a knot and slides it to its head."};
  app.set_version_flag("--version", hagfish::build_version() + " " + hagfish::build_revision());
  app.require_subcommand(1);
  const std::string typed = joined(argc, argv);
  int code = 0;
  add_run(app, typed, code);
  app.add_subcommand("scenes", "list the built-in scenes")->callback([&code] {
    code = hagfish::list_scenes();
  });
  add_record_qp(app, typed, code);
  add_qp(app, code);
  add_log_readers(app, code);
#ifdef HAGFISH_MUJOCO
  add_picture(app, code);
  add_mjcf(app, code);
  add_compare(app, typed, code);
  add_integrate(app, typed, code);
  add_playback(app, typed, code);
  add_stress(app, code);
#endif

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      return app.exit(error);  // help and version
    }
    fmt::print(stderr, "hagfish: {} (see hagfish --help)\n", error.what());
    return bad_input;
  }
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const hagfish::InputError& error) {
    fmt::print(stderr, "hagfish: {}\n", error.what());
  } catch (const hagfish::FileError& error) {
    fmt::print(stderr, "hagfish: {}\n", error.what());
  } catch (const std::exception& error) {
    fmt::print(stderr, "hagfish: unforeseen: {}\n", error.what());
  }
  return bad_input;
}
