// Runs a built-in scene until its knot is tied and says which one it is.
#include <iostream>

#include "core/input/builtin_files.hpp"
#include "core/input/files/scene_reader.hpp"
#include "core/run/simulation.hpp"

int main() {
  using namespace hagfish;
  const std::string text(builtin_file("table1.toml").value());
  const ResolvedScene resolved = read_scene_text(text, "table1", {"time.step=0.005"});
  const Scene& scene = resolved.scene;
  const Model& model = resolved.model;
  Simulation sim = start(model, scene, "active-set");
  StepRecord record;
  while (record.controller.phase == Phase::form && !finished(sim, scene)) {
    take_step(model, scene, sim, record);
  }
  std::cout << knot_name(record.controller.knot.type) << " tied at " << record.time << " s\n";
}
