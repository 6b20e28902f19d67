#include "experiments/mujoco/studies.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "core/input/input_error.hpp"
#include "core/step/step.hpp"
#include "experiments/mujoco/motions.hpp"
#include "mujoco_ref/agreement.hpp"
#include "mujoco_ref/mirror.hpp"
#include "mujoco_ref/rollout.hpp"

namespace hagfish {
namespace {

/// What is compared. Everything is smooth: contacts, limits, drag and script are left out.
struct Comparison {
  int states = 1000;   ///< random states for each way the head hangs
  double angle = 3.1;  ///< hinge angles of those to either side, rad
  double spin = 100;   ///< and velocities, cm/s and rad/s
  unsigned seed = 1;
  double rollout_time = 1;       ///< the coil opens step by step at the scene's h, s
  double rollout_bound = 1e-8;   ///< largest difference in q̇ there
  double error_time = 0.5;       ///< errors are taken here, s
  double reference_step = 2e-4;  ///< of MuJoCo's RK4, which they are taken against, s
  std::array<double, 5> steps = {0.008, 0.004, 0.002, 0.001, 0.0005};  ///< s
};

struct Rule {
  const char* name;
  int integrator;  ///< MuJoCo's; not used for the core
};
constexpr Rule core_rule{"core", -1};
constexpr std::array<Rule, 4> rules{{core_rule,
                                     {"mujoco_euler", mjINT_EULER},
                                     {"mujoco_implicit", mjINT_IMPLICIT},
                                     {"mujoco_rk4", mjINT_RK4}}};

const char* head_name(Head head) { return head == Head::free ? "free" : "clamped"; }

/// Results of one run.
class Findings {
 public:
  explicit Findings(Hdf5Writer& file) : h5(file) {}
  /// Prints a line of the table; returns whether the bound holds.
  bool row(Head head, const char* quantity, double value, double bound) {
    const bool ok = value <= bound;
    fmt::print("{:<8} {:<34} {:>9.1e} {:>9.0e}  {}\n", head_name(head), quantity, value, bound,
               ok ? "ok" : "FAIL");
    passed_ = passed_ && ok;
    return ok;
  }
  bool passed() const { return passed_; }
  /// Writes the bound on the numbers at `path`.
  void bound(const std::string& path, double most) {
    h5.numbers(path + "_bound", Eigen::VectorXd::Constant(1, most), {"1", "at most this"});
  }
  Hdf5Writer& h5;

 private:
  bool passed_ = true;
};

MujocoModel mirror_of(const Model& model, double h, Head head) {
  return MujocoModel(mjcf_files(model, 0, h, head));
}

void compare_states(const Model& model, Head head, double h, const Comparison& settings,
                    Findings& findings) {
  MujocoModel mirror = mirror_of(model, h, head);
  std::mt19937 random(settings.seed);
  Eigen::MatrixXd all(5, settings.states);
  Agreement largest;
  for (int i = 0; i < settings.states; ++i) {
    const State state = drawn_state(random, model, head, settings.angle, settings.spin);
    const Agreement a = agreement(model, state, mirror);
    all.col(i) << a.position, a.orientation, a.mass, a.bias, a.acceleration;
    largest = worst(largest, a);
  }
  const std::array<const char*, 5> names = {"position", "orientation", "mass", "bias",
                                            "acceleration"};
  const std::array<const char*, 5> texts = {"positions / length", "orientations",
                                            "M, unit diagonal", "bias and passive forces",
                                            "acceleration"};
  const Agreement& bound = agreement_bound;
  const std::array<double, 5> found = {largest.position, largest.orientation, largest.mass,
                                       largest.bias, largest.acceleration};
  const std::array<double, 5> bounds = {bound.position, bound.orientation, bound.mass, bound.bias,
                                        acceleration_bound(largest.condition)};
  const std::string group = std::string("/states/") + head_name(head);
  findings.h5.group(group);
  for (int i = 0; i < 5; ++i) {
    findings.row(head, texts[i], found[i], bounds[i]);
    findings.h5.numbers(
        group + "/" + names[i], all.row(i).transpose(),
        {"1", fmt::format("difference of {} in each random state, over its scale", texts[i])});
    findings.bound(group + "/" + names[i], bounds[i]);
  }
}

/// Steps of the rollout. Throws InputError where there are none or very many.
int rollout_steps(double h, const Comparison& settings) {
  constexpr double most = 1e5;
  const double steps = std::round(settings.rollout_time / h);
  if (!(steps >= 1 && steps <= most)) {
    throw InputError(
        fmt::format("time.step = {:g} s: the comparison lasts {:g} s and must take 1 to {:g} steps",
                    h, settings.rollout_time, most));
  }
  return static_cast<int>(steps);
}

void compare_rollouts(const Model& model, Head head, double h, int steps,
                      const Comparison& settings, Findings& findings) {
  const State start = start_of(motions.front(), model);
  MujocoModel mirror = mirror_of(model, h, head);
  use_core_rule(mirror);
  const std::vector<State> core = core_rollout(model, start, head, TimeRule::euler, h, steps);
  const std::vector<State> mujoco = mujoco_rollout(model, start, mirror, steps);
  Eigen::VectorXd time(steps), velocity(steps), distance(steps);
  for (int i = 0; i < steps; ++i) {
    time[i] = (i + 1) * h;
    velocity[i] = velocity_difference(core[i], mujoco[i]);
    distance[i] = centre_distance(model, core[i], mujoco[i]);
  }
  findings.row(head, fmt::format("velocities, {} steps of {:g} s", steps, h).c_str(),
               velocity.maxCoeff(), settings.rollout_bound);
  const std::string group = std::string("/rollout/") + head_name(head);
  findings.h5.group(group);
  findings.h5.numbers(group + "/time", time, {"s", "time of each step's end"});
  findings.h5.numbers(group + "/velocity", velocity,
                      {"1", "largest difference in q̇ over the largest q̇"});
  findings.bound(group + "/velocity", settings.rollout_bound);
  findings.h5.numbers(group + "/distance", distance,
                      {"cm", "largest distance between body centres"});
}

State end_of(const Rule& rule, const Model& model, const State& start, Head head, double h,
             double time) {
  const int steps = static_cast<int>(std::lround(time / h));
  if (rule.integrator == core_rule.integrator) {
    return core_rollout(model, start, head, TimeRule::euler, h, steps).back();
  }
  MujocoModel mirror = mirror_of(model, h, head);
  mirror.model()->opt.integrator = rule.integrator;
  return mujoco_rollout(model, start, mirror, steps).back();
}

void compare_errors(const Model& model, Head head, const Comparison& settings, Findings& findings) {
  const State start = start_of(motions.front(), model);
  const State reference =
      end_of(rules.back(), model, start, head, settings.reference_step, settings.error_time);
  const std::string group = std::string("/error/") + head_name(head);
  findings.h5.group(group);
  findings.h5.numbers(
      group + "/h", Eigen::Map<const Eigen::VectorXd>(settings.steps.data(), settings.steps.size()),
      {"s", "time steps"});
  fmt::print("\n{:<8} {:<16}", head_name(head), "h, s:");
  for (const double h : settings.steps) fmt::print(" {:>9g}", h);
  fmt::print("\n");
  for (const Rule& rule : rules) {
    Eigen::VectorXd error(settings.steps.size());
    fmt::print("{:<8} {:<16}", "", rule.name);
    for (std::size_t i = 0; i < settings.steps.size(); ++i) {
      double& value = error[static_cast<Eigen::Index>(i)];
      try {
        const State end = end_of(rule, model, start, head, settings.steps[i], settings.error_time);
        value = centre_distance(model, end, reference);
        fmt::print(" {:>9.2e}", value);
      } catch (const StepError&) {
        value = INFINITY;
        fmt::print(" {:>9}", "blew up");
      }
      std::fflush(stdout);
    }
    fmt::print("\n");
    findings.h5.numbers(group + "/" + rule.name, error,
                        {"cm", fmt::format("largest error of a body centre at t = {:g} s, infinite "
                                           "where the method blew up",
                                           settings.error_time)});
  }
}

}  // namespace

bool compare(const ResolvedScene& resolved, Hdf5Writer& h5) {
  const Model model = smooth(resolved.model);
  const double h = resolved.scene.time.step;
  const Comparison settings;
  const int steps = rollout_steps(h, settings);
  Findings findings(h5);
  for (const char* group : {"/states", "/rollout", "/error"}) h5.group(group);
  fmt::print("{} bodies, {} random states; contacts, limits and drag left out\n\n",
             model.body_count(), settings.states);
  fmt::print("{:<8} {:<34} {:>9} {:>9}\n", "head", "largest difference in", "found", "bound");
  for (const Head head : {Head::free, Head::clamped}) {
    compare_states(model, head, h, settings, findings);
    compare_rollouts(model, head, h, steps, settings, findings);
  }
  fmt::print("\nError of a body centre at {:g} s, cm, against MuJoCo's RK4 at {:g} s\n",
             settings.error_time, settings.reference_step);
  for (const Head head : {Head::free, Head::clamped}) {
    compare_errors(model, head, settings, findings);
  }
  return findings.passed();
}

}  // namespace hagfish
