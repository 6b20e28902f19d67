#include "experiments/mujoco/studies.hpp"

#include "core/log/hdf5/output_file.hpp"
#include "experiments/program/program.hpp"

namespace hagfish {
namespace {

struct PlaybackOptions {
  std::string log;     ///< with restart intervals of whole frames
  std::string out;     ///< HDF5 file for the figure
  bool force = false;  ///< replace an existing file
};

int run_playback(const PlaybackOptions& options, const std::string& typed) {
  const LogContents log(options.log);
  OutputFile file(options.out, replaced_if(options.force));
  Hdf5Writer h5;
  h5.root_attribute("log", options.log);
  h5.root_attribute("command", typed);
  playback(log, h5);
  h5.save(file.partial());
  file.publish();
  return exit_code::done;
}

}  // namespace

void add_playback(Program& program) {
  const auto options = std::make_shared<PlaybackOptions>();
  CLI::App* playback_app = program.app.add_subcommand(
      "playback",
      "slide a log's knot in MuJoCo, with its own contacts, by mean f_thigmo from frame to frame");
  playback_app->add_option("LOG", options->log, "log whose knot slides")->required();
  playback_app->add_option("--out", options->out, "HDF5 file to write")->required();
  playback_app->add_flag("--force", options->force, "replace an existing file");
  playback_app->callback(
      [options, &program] { program.code = run_playback(*options, program.typed); });
}

}  // namespace hagfish
