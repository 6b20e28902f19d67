// A MuJoCo model and its state, owned.
#pragma once

#include <mujoco/mujoco.h>

#include <map>
#include <memory>
#include <string>

namespace hagfish {

class MujocoModel {
 public:
  /// Loads MJCF texts by file name (mjcf.hpp), held in memory; the state is MuJoCo's initial one.
  /// Throws std::runtime_error, one line with the file's name and MuJoCo's own message, where
  /// MuJoCo rejects or only warns about a file. The name is that of the file that is not XML, or of
  /// the root document: MuJoCo forgets which file the rest came from.
  /// From the first one on, errors of MuJoCo anywhere are thrown as std::runtime_error, "MuJoCo:
  /// ..." in one line, and it writes nothing of its own.
  explicit MujocoModel(const std::map<std::string, std::string>& files);

  const mjModel* model() const { return model_.get(); }
  mjModel* model() { return model_.get(); }
  const mjData* data() const { return data_.get(); }
  mjData* data() { return data_.get(); }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
};

}  // namespace hagfish
