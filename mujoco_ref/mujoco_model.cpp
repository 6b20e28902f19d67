#include "mujoco_ref/mujoco_model.hpp"

#include <array>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "mujoco_ref/mjcf.hpp"

namespace hagfish {
namespace {

using Files = std::map<std::string, std::string>;

/// `message` with every run of white space as one blank: MuJoCo's span lines.
std::string one_line(const std::string& message) {
  std::istringstream words(message);
  std::string line;
  for (std::string word; words >> word;) line += line.empty() ? word : ' ' + word;
  return line;
}

[[noreturn]] void fail(const std::string& file, const std::string& reason) {
  throw std::runtime_error(file + ": " + reason);
}

struct DeleteFiles {
  void operator()(mjVFS* vfs) const {
    mj_deleteVFS(vfs);
    delete vfs;
  }
};
using FileSystem = std::unique_ptr<mjVFS, DeleteFiles>;

FileSystem file_system(const Files& files) {
  FileSystem vfs(new mjVFS);
  mj_defaultVFS(vfs.get());
  for (const auto& [name, text] : files) {
    if (text.empty()) fail(name, "empty file");  // MuJoCo would end the program
    const int status = mj_makeEmptyFileVFS(vfs.get(), name.c_str(), static_cast<int>(text.size()));
    if (status != 0) fail(name, status == 1 ? "too many MJCF files" : "repeated MJCF file name");
    const int index = mj_findFileVFS(vfs.get(), name.c_str());
    std::memcpy(vfs->filedata[index], text.data(), text.size());
  }
  return vfs;
}

/// MuJoCo's own handlers write a file into the working folder, and wait for a key after an error.
void install_handlers() {
  mju_user_warning = [](const char*) {};  // each is counted in mjData
  // Whoever returns from here goes on in MuJoCo where it cannot go on.
  mju_user_error = [](const char* message) {
    throw std::runtime_error("MuJoCo: " + one_line(message));
  };
}

/// Loads `file` as the root document; `message` is what MuJoCo said, empty where all is well.
mjModel* load(const mjVFS* vfs, const std::string& file, std::string& message) {
  std::array<char, 1024> text{};
  mjModel* model = mj_loadXML(file.c_str(), vfs, text.data(), static_cast<int>(text.size()));
  message = one_line(text.data());
  return model;
}

/// Says which file MuJoCo rejected: the one that is not XML, found by reading each as a root
/// document of its own, or else the root document.
[[noreturn]] void fail_loading(const mjVFS* vfs, const Files& files, const std::string& reason) {
  for (const auto& [name, text] : files) {
    std::string message;
    mj_deleteModel(load(vfs, name, message));
    if (message.starts_with("XML parse error")) fail(name, message);
  }
  fail(mjcf_root_file, reason);
}

}  // namespace

MujocoModel::MujocoModel(const Files& files) {
  install_handlers();
  const FileSystem vfs = file_system(files);
  std::string message;
  model_.reset(load(vfs.get(), mjcf_root_file, message));
  if (!model_ || !message.empty()) fail_loading(vfs.get(), files, message);
  data_.reset(mj_makeData(model_.get()));
  if (!data_) fail(mjcf_root_file, "MuJoCo cannot allocate its state");
}

}  // namespace hagfish
