#include "core/run/drive.hpp"

namespace hagfish {

Status drive(const Scene& scene, const TakeStep& take, Simulation& sim, StepRecord& record,
             std::initializer_list<Watcher> watchers, const Stop& stop) {
  while (!finished(sim, scene)) {
    if (stop && stop()) return {Outcome::stopped, "stopped"};
    try {
      take(sim, record);
    } catch (const StepError& error) {
      return {error.outcome(), error.what()};
    }
    for (const Watcher& watch : watchers) watch(record, sim);
  }
  return {};
}

Status drive(const Model& model, const Scene& scene, Simulation& sim, StepRecord& record,
             std::initializer_list<Watcher> watchers, const Stop& stop) {
  const auto take = [&](Simulation& of, StepRecord& step) { take_step(model, scene, of, step); };
  return drive(scene, take, sim, record, watchers, stop);
}

}  // namespace hagfish
