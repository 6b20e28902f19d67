#include "tests/support/written_log.hpp"

#include "core/log/hdf5/hdf5_error.hpp"
#include "core/log/log_writer.hpp"
#include "experiments/audit/audit.hpp"
#include "mujoco_ref/mjcf.hpp"

namespace hagfish {

void write_log(const std::filesystem::path& file, SceneRun run, int most_steps) {
  LogHeader header;
  header.qp = "active-set";
  header.scene = scene_to_toml(run.scene, run.specimen);
  header.mjcf = mjcf_files(run.model, run.scene.contact.least_arc, run.scene.time.step);
  LogWriter log(file, true, header, run.model, run.scene);
  double wall_time = 0;
  for (int k = 0; k < most_steps && !run.over(); ++k) {
    run.step();
    log.write(run.record, run.sim, wall_time += 1e-4);
  }
  log.finish("complete", run.sim);
}

std::string audit_objections(const std::filesystem::path& file) try {
  std::string text;
  for (const Finding& finding : audit(file)) {
    text += finding.passed ? "" : finding.name + ": " + finding.text + "\n";
  }
  return text;
} catch (const FileError& error) {
  return error.what();
}

std::string audit_objections_as(const std::filesystem::path& file, const ResolvedScene& scene) {
  const std::string before = write_scene(file, scene_to_toml(scene.scene, scene.specimen));
  const std::string text = audit_objections(file);
  write_scene(file, before);
  return text;
}

std::string write_scene(const std::filesystem::path& file, const std::string& text) {
  std::string before;
  H5::H5File h5(file.string(), H5F_ACC_RDWR);
  H5::Group root = h5.openGroup("/");
  const H5::Attribute attribute = root.openAttribute("scene");
  attribute.read(attribute.getStrType(), before);
  root.removeAttr("scene");
  const H5::StrType type(H5::PredType::C_S1, H5T_VARIABLE);
  root.createAttribute("scene", type, H5::DataSpace(H5S_SCALAR)).write(type, text);
  return before;
}

}  // namespace hagfish
