#include "core/control/untaken_step.hpp"

namespace hagfish {

void UntakenStep::begin(const Situation& at, const Scene& scene) {
  solver.warm.forget();
  const StepInput in{at.model, scene, at.now.state, at.now.observation, control};
  if (const Status status = solver.begin(in, step); !status.ok()) throw StepError(status);
}

void UntakenStep::solve(const Situation& at, const Scene& scene) {
  begin(at, scene);
  solver.finish({at.model, scene, at.now.state, at.now.observation, control}, step);
}

}  // namespace hagfish
