#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/chain/model.hpp"
#include "core/input/input_error.hpp"
#include "core/log/hdf5_error.hpp"
#include "experiments/program/commands.hpp"
#include "experiments/program/scene_argument.hpp"
#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

void write_text(const fs::path& file, const std::string& text, bool replace) {
  std::error_code error;
  if (!replace && fs::exists(file, error)) {
    throw FileError(file.string() + ": already exists (--force replaces it)");
  }
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) {
    throw FileError(file.string() + ": cannot write: " + std::strerror(errno));
  }
}

}  // namespace

int mjcf(const MjcfOptions& options) {
  const ResolvedScene resolved = scene_argument(options.scene, options.set);
  const Scene& scene = resolved.scene;
  const Model model = make_hagfish(resolved.specimen, scene);
  const auto files = mjcf_files(model, scene.contact.least_arc, scene.time.step,
                                options.clamp ? Head::clamped : Head::free);
  try {
    const MujocoModel loaded(files);
  } catch (const std::runtime_error& error) {
    throw InputError(options.scene + ": MuJoCo rejects the model: " + error.what());
  }
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error) {
    throw FileError(options.out + ": cannot make the folder: " + error.message());
  }
  for (const auto& [name, text] : files) {
    write_text(fs::path(options.out) / name, text, options.force);
  }
  fmt::print("{}: {} bodies in {} files\n", (fs::path(options.out) / mjcf_root_file).string(),
             model.body_count(), files.size());
  return 0;
}

}  // namespace hagfish
