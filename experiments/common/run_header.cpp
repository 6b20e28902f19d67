#include "experiments/common/run_header.hpp"

#include "core/log/build_info.hpp"
#include "mujoco_ref/mjcf.hpp"

namespace hagfish {

LogHeader log_header(const ResolvedScene& resolved, const std::string& qp,
                     const std::string& typed) {
  const Scene& scene = resolved.scene;
  LogHeader header;
  header.command = typed;
  header.scene = scene_to_toml(scene, resolved.specimen);
  header.qp = qp;
  header.libraries = build_libraries();
  header.mjcf = mjcf_files(resolved.model, scene.contact.least_arc, scene.time.step);
  return header;
}

}  // namespace hagfish
