#include "experiments/mujoco/stress.hpp"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>

#include "core/run/drive.hpp"
#include "experiments/common/cpu_time.hpp"
#include "experiments/mujoco/stress_mujoco.hpp"
#include "solvers/box_qp.hpp"

namespace hagfish {
namespace {

constexpr const char* active_set = "active-set";
constexpr int core_stepper = -1;

/// How a cell's steps are taken.
struct StressMethod {
  const char* name;
  int integrator;                      ///< MuJoCo's, or core_stepper
  const char* qp;                      ///< back end of the core
  std::array<const char*, 2> changes;  ///< KEY=VALUE of the scene; none where empty
  bool hard = false;                   ///< MuJoCo's contacts and limits are stiff ones
};
constexpr const char* unwatched = "guard.energy_action=warn";
constexpr std::array<StressMethod, 12> stress_rules{
    {{"default", core_stepper, active_set, {"", ""}},
     {"no_watch", core_stepper, active_set, {unwatched, ""}},
     {"midpoint", core_stepper, active_set, {"time.rule=midpoint", ""}},
     {"violated", core_stepper, active_set, {"constraints.activation=violated", ""}},
     {"baumgarte_0.2", core_stepper, active_set, {"constraints.baumgarte=0.2", ""}},
     {"baumgarte_1", core_stepper, active_set, {"constraints.baumgarte=1", ""}},
     {"hard_thigmotaxis", core_stepper, active_set, {"controller.cap=1e9", ""}},
     {"ipopt", core_stepper, "ipopt", {"", ""}},
     {"mujoco_euler", mjINT_EULER, "", {"", ""}},
     {"mujoco_hard", mjINT_EULER, "", {"", ""}, true},
     {"mujoco_implicit", mjINT_IMPLICIT, "", {"", ""}},
     {"mujoco_rk4", mjINT_RK4, "", {"", ""}}}};

const StressMethod& method_called(const std::string& name) {
  const auto* found = std::find_if(stress_rules.begin(), stress_rules.end(),
                                   [&](const StressMethod& m) { return m.name == name; });
  if (found == stress_rules.end()) {
    throw std::invalid_argument("unknown method '" + name + "'");
  }
  return *found;
}

/// Whether the run came to its end in time. Throws StepError as take_step.
bool run_in_core(const Model& model, const Scene& scene, const char* qp,
                 const std::function<bool()>& out_of_time, StressJudge& judge) {
  Simulation sim = start(model, scene, qp);
  sim.solver.stop_when(out_of_time);
  StepRecord record;
  const auto see = [&](const State& before, const ObservedState& after) {
    const EnergyLedger& ledger = sim.ledger;
    judge.see(before, after.state, after.observation, time_of(sim, scene),
              {ledger.kinetic + ledger.elastic + ledger.gravity,
               ledger.work_tip + ledger.work_active + ledger.work[RowKind::thigmotaxis]});
  };
  const auto watch = [&](const StepRecord& step, const Simulation& of) {
    judge.see_control(step);
    see(step.after.state, of.now);
  };
  const Status end = drive(model, scene, sim, record, {watch}, out_of_time);
  if (end.ok() || end.outcome == Outcome::stopped) return end.ok();
  // A guard refused where the step led: that is in the record, while the simulation stayed.
  if (end.outcome == Outcome::penetration || end.outcome == Outcome::limits) {
    see(sim.now.state, record.after);
  }
  throw StepError(end);
}

Status run_cell(const Model& model, const Scene& scene, const StressMethod& method,
                double cpu_limit, StressJudge& judge) {
  const double begin = cpu_time();
  const auto out_of_time = [&] { return cpu_time() - begin > cpu_limit; };
  const bool core = method.integrator == core_stepper;
  if (const std::string why = core ? "" : not_in_mujoco(scene); !why.empty()) {
    return {Outcome::not_applicable, why};
  }
  try {
    const bool done = core ? run_in_core(model, scene, method.qp, out_of_time, judge)
                           : run_in_mujoco(model, scene, start_state(model, scene.start),
                                           method.integrator, method.hard, out_of_time, judge);
    return done ? judge.ended()
                : Status{Outcome::capped, fmt::format("not done in {:g} s of CPU", cpu_limit)};
  } catch (const StepError& error) {
    return judge.stopped(error);
  } catch (const std::domain_error& error) {  // the body is past having a knot type
    return judge.stopped(StepError({Outcome::knot_lost, error.what()}));
  } catch (const std::overflow_error& error) {
    return judge.stopped(StepError({Outcome::knot_lost, error.what()}));
  }
}

}  // namespace

std::vector<std::string> stress_methods() {
  std::vector<std::string> names;
  for (const StressMethod& method : stress_rules) {
    names.emplace_back(method.name);
  }
  return names;
}

std::vector<std::string> stress_overrides(const std::string& method, double step) {
  std::vector<std::string> set;
  for (const std::string change : method_called(method).changes) {
    if (!change.empty()) set.push_back(change);
  }
  if (step > 0) {
    set.push_back(fmt::format("time.step={}", step));
    set.push_back(fmt::format("time.frame_interval={}", step));
  }
  return set;
}

StressResult stress(const Scene& scene, const Model& model, const std::string& method,
                    double cpu_limit) {
  const State first = start_state(model, scene.start);
  StressJudge judge(model, scene, first, mechanical_energy(model, first, kinematics(model, first)));
  const double begin = cpu_time();
  const Status status = run_cell(model, scene, method_called(method), cpu_limit, judge);
  return {status, judge.figures(), cpu_time() - begin};
}

}  // namespace hagfish
