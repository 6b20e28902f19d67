#include "experiments/benchmarks/start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/log/hdf5/hdf5_error.hpp"
#include "core/log/reading/log_contents.hpp"
#include "mujoco_ref/mirror.hpp"

namespace hagfish {
namespace {

// The wave: hinge angles as a share of their limits, which falls where it would bring strands
// close; waves along the body; and the share of the angles that they change by in a second.
constexpr double wave_share = 0.1;
constexpr double wave_count = 2;
constexpr double wave_rate = 0.5;

constexpr const char* back_end = "active-set";
// By then limits are prescribed (from the third step on), and all storage has its size.
constexpr int warm_steps = 6;

void add_warmed(Simulation sim, Start& start) {
  for (int k = 0; k < warm_steps; ++k) {
    take_step(start.model, start.scene, sim);
  }
  start.sims.push_back(std::move(sim));
}

// Of the slide. A single one is dearer or cheaper than the next by a third, and at 400 bodies by
// more.
constexpr int knotted_states = 5;

bool clamped(const Start& start) {
  return clamps_head(start.scene, start.middle().controller.phase);
}

}  // namespace

Start knotted_start(const std::string& log, TimeRule rule) {
  const LogContents contents(log);
  const auto slide = static_cast<std::int64_t>(Phase::slide);
  const auto [first, last] = std::equal_range(contents.phase.begin(), contents.phase.end(), slide);
  if (first == last) {
    throw FileError(log + ": has no slide of the knot");
  }
  Start start{contents.resolved.scene, contents.model, {}};
  start.scene.time.rule = rule;
  for (int k = 0; k < knotted_states; ++k) {
    const Eigen::Index frame =
        (first - contents.phase.begin()) + (last - first) * (2 * k + 1) / (2 * knotted_states);
    ControllerState controller;
    controller.phase = Phase::slide;
    controller.phase_start = contents.time[frame];
    controller.loose = controller.phase_start;
    add_warmed(start_from(start.model, start.scene, back_end,
                          {contents.q.row(frame).transpose(), contents.qdot.row(frame).transpose()},
                          controller, std::llround(contents.time[frame] / start.scene.time.step)),
               start);
  }
  return start;
}

Start free_start(const Start& knotted) {
  Model model = knotted.model;
  model.obstacles.clear();
  State state = rest_state(model);
  const Eigen::Matrix2Xd ranges = hinge_ranges(model);
  for (std::size_t k = 0; k < model.hinges.size(); ++k) {
    const double along = static_cast<double>(model.hinges[k].body) / model.body_count();
    const auto i = static_cast<Eigen::Index>(k) + root_dofs;
    const double most = ranges(1, static_cast<Eigen::Index>(k));
    state.q[i + 1] = wave_share * most * std::sin(2 * std::numbers::pi * wave_count * along);
    state.qdot[i] = wave_rate * state.q[i + 1];
  }
  ControllerState controller;
  controller.phase = Phase::free;
  // Never over, however long the benchmark runs.
  Scene scene = knotted.scene;
  scene.time.duration = std::numeric_limits<double>::infinity();
  scene.controller.free_time = scene.time.duration;
  Start start{scene, model, {}};
  add_warmed(start_from(model, scene, back_end, std::move(state), controller, 0), start);
  return start;
}

MujocoModel mirror_of(const Start& start) {
  MujocoModel mirror(mjcf_files(start.model, start.scene.contact.least_arc, start.scene.time.step,
                                clamped(start) ? Head::clamped : Head::free));
  std::fill_n(mirror.model()->geom_margin, mirror.model()->ngeom, 0.0);
  mirror.model()->opt.integrator = mjINT_EULER;
  set_state(start.model, start.middle().now.state, mirror);
  mj_forward(mirror.model(), mirror.data());
  return mirror;
}

}  // namespace hagfish
