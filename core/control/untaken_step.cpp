#include "core/control/untaken_step.hpp"

namespace hagfish {
namespace {

StepInput input_of(const Situation& at, const Scene& scene, UntakenStep& untaken) {
  return {at.model, scene, at.now.state, at.now.observation, untaken.control};
}

}  // namespace

void begin_untaken(const Situation& at, const Scene& scene, UntakenStep& untaken) {
  untaken.solver.warm.forget();
  if (const Status status = untaken.solver.begin(input_of(at, scene, untaken), untaken.step);
      !status.ok()) {
    throw StepError(status);
  }
}

void solve_untaken(const Situation& at, const Scene& scene, UntakenStep& untaken) {
  begin_untaken(at, scene, untaken);
  untaken.solver.finish(input_of(at, scene, untaken), untaken.step);
}

}  // namespace hagfish
