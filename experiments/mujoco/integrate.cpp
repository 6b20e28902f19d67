#include "experiments/mujoco/studies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/step/step.hpp"
#include "experiments/common/cpu_time.hpp"
#include "experiments/common/terminal.hpp"
#include "mujoco_ref/rollout.hpp"

namespace hagfish {
namespace {

/// How the methods are measured.
struct Measurement {
  double duration = 0.5;         ///< errors are taken here, s
  double reference_step = 2e-4;  ///< of MuJoCo's RK4, s; half of it is the reference
  int repeats = 3;               ///< the least CPU time of these counts
  double long_run = 1;           ///< a run that takes this much of it is not repeated, s
  std::array<double, 9> steps = {0.02,   0.01,    0.005,    0.002,    0.001,
                                 0.0005, 0.00025, 0.000125, 0.0000625};  ///< s
};

struct Method {
  const char* name;
  const char* title;
  int integrator;        ///< MuJoCo's, or not_mujoco
  TimeRule rule;         ///< the core's
  double smallest_step;  ///< below this it takes long and shows nothing new, s
};
constexpr int not_mujoco = -1;
constexpr std::array<Method, 5> methods{
    {{"core", "core, Euler", not_mujoco, TimeRule::euler, 6e-5},
     {"core_midpoint", "core, midpoint", not_mujoco, TimeRule::midpoint, 6e-5},
     {"mujoco_euler", "MuJoCo Euler", mjINT_EULER, {}, 2e-4},
     {"mujoco_implicit", "MuJoCo implicit", mjINT_IMPLICIT, {}, 2e-4},
     {"mujoco_rk4", "MuJoCo RK4", mjINT_RK4, {}, 4e-4}}};

struct Ending {
  State state;
  double cost = 0;  ///< CPU time, s
};

/// The motion's end by a method, and what the steps alone cost; nothing where it blew up.
std::optional<Ending> end_of(const Method& method, const Model& model, const State& start, double h,
                             double duration) {
  const int steps = static_cast<int>(std::lround(duration / h));
  Ending ending;
  try {
    if (method.integrator == not_mujoco) {
      const double before = cpu_time();
      ending.state = core_rollout(model, start, Head::clamped, method.rule, h, steps).back();
      ending.cost = cpu_time() - before;
      return ending;
    }
    MujocoModel mirror(mjcf_files(model, 0, h, Head::clamped));
    mirror.model()->opt.integrator = method.integrator;
    const double before = cpu_time();
    ending.state = mujoco_rollout(model, start, mirror, steps).back();
    ending.cost = cpu_time() - before;
    return ending;
  } catch (const StepError&) {
    return std::nullopt;
  }
}

std::optional<Ending> measured(const Method& method, const Model& model, const State& start,
                               double h, const Measurement& settings) {
  std::optional<Ending> best = end_of(method, model, start, h, settings.duration);
  for (int i = 1; best && best->cost < settings.long_run && i < settings.repeats; ++i) {
    best->cost = std::min(best->cost, end_of(method, model, start, h, settings.duration)->cost);
  }
  return best;
}

void measure(const Method& method, const Model& model, const State& start, const State& reference,
             const Measurement& settings, Hdf5Writer& h5) {
  std::vector<double> step, error, cost;
  for (const double h : settings.steps) {
    if (h < method.smallest_step) {
      continue;
    }
    const auto ending = measured(method, model, start, h, settings);
    step.push_back(h);
    error.push_back(ending ? centre_distance(model, ending->state, reference) : INFINITY);
    cost.push_back(ending ? ending->cost / settings.duration : NAN);
    if (ending) {
      fmt::print("{:<20} {:>9g} {:>11.3e} {:>11.3e}\n", method.title, 1e3 * h, error.back(),
                 cost.back());
    } else {
      fmt::print("{:<20} {:>9g} {:>11}\n", method.title, 1e3 * h, "blew up");
    }
  }
  const auto array = [](const std::vector<double>& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                             static_cast<Eigen::Index>(values.size()));
  };
  const std::string group = std::string("/") + method.name;
  h5.group(group);
  h5.numbers(group + "/h", array(step), {"s", "time steps"});
  h5.numbers(group + "/error", array(error),
             {"cm", "largest error of a body centre at the end; infinite where it blew up"});
  h5.numbers(group + "/cost", array(cost),
             {"1", "CPU time per simulated time of the steps alone; nan where it blew up"});
}

}  // namespace

bool integrate(const ResolvedScene& resolved, const Motion& motion, Hdf5Writer& h5) {
  Model model = smooth(resolved.model);
  model.gravity = {motion.gravity, 0, 0};
  const State start = start_of(motion, model);
  const Measurement settings;
  const Method& rk4 = methods.back();
  const double h = settings.reference_step;
  const auto coarse = end_of(rk4, model, start, h, settings.duration);
  const auto fine = end_of(rk4, model, start, h / 2, settings.duration);
  if (!coarse || !fine) {
    say("hagfish: {}: the reference blew up\n", motion.name);
    return false;
  }
  const double agreement = centre_distance(model, coarse->state, fine->state);
  fmt::print("{}, {} bodies, {:g} s; references at {:g} and {:g} ms agree to {:.1e} cm\n",
             motion.title, model.body_count(), settings.duration, 1e3 * h, 5e2 * h, agreement);
  fmt::print("{:<20} {:>9} {:>11} {:>11}\n", "method", "h, ms", "error, cm", "CPU s/s");
  for (const Method& method : methods) {
    measure(method, model, start, fine->state, settings, h5);
  }
  h5.group("/reference");
  h5.numbers("/reference/agreement", Eigen::VectorXd::Constant(1, agreement),
             {"cm", fmt::format("largest distance of a body centre at the end between RK4 at {:g} "
                                "and {:g} s, the reference",
                                h, h / 2)});
  h5.root_attribute("motion", std::string(motion.title));
  return true;
}

}  // namespace hagfish
