#include "tests/support/written_log.hpp"

#include "core/log/log_writer.hpp"
#include "mujoco_ref/mjcf.hpp"

namespace hagfish {

void write_log(const std::filesystem::path& file, const ResolvedScene& scene, const Model& model,
               Simulation sim, int most_steps) {
  LogHeader header;
  header.qp = "active-set";
  header.scene = scene_to_toml(scene.scene, scene.specimen);
  header.mjcf = mjcf_files(model, scene.scene.contact.least_arc, scene.scene.time.step);
  LogWriter log(file, true, header, model, scene.scene);
  StepRecord record;
  double wall_time = 0;
  for (int k = 0; k < most_steps && !finished(sim, scene.scene); ++k) {
    take_step(model, scene.scene, sim, record);
    log.write(record, sim, wall_time += 1e-4);
  }
  log.finish("complete", sim);
}

}  // namespace hagfish
