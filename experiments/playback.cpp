#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/controller.hpp"
#include "core/dynamics.hpp"
#include "core/hdf5_writer.hpp"
#include "core/step.hpp"
#include "experiments/commands.hpp"
#include "experiments/log_contents.hpp"
#include "mujoco_ref/log_model.hpp"
#include "mujoco_ref/mirror.hpp"

namespace hagfish {
namespace {

/// Times between restarts from the log, s.
constexpr std::array<double, 5> intervals = {0.05, 0.1, 0.2, 0.5, 1.0};
/// The knot type is looked at this often, s.
constexpr double knot_interval = 0.01;

/// The sliding phase of a log that holds every step.
struct Slide {
  explicit Slide(const LogContents& log);
  State state(Eigen::Index i) const { return {q.row(i), qdot.row(i)}; }
  Eigen::Index steps() const { return q.rows() - 1; }
  Hdf5Reader::Rows q, qdot, force;  ///< a row a step; f_thigmo
  double start = 0;                 ///< s
};

Slide::Slide(const LogContents& log) {
  const auto slides = [](std::int64_t phase) { return phase == static_cast<int>(Phase::slide); };
  const auto first = std::find_if(log.phase.begin(), log.phase.end(), slides);
  const auto last = std::find_if_not(first, log.phase.end(), slides);
  const auto begin = first - log.phase.begin();
  const auto count = last - first;
  if (count < 2) {
    throw FileError(log.h5.file() + ": the knot does not slide in it");
  }
  const std::vector<std::int64_t> step = log.h5.integers("/trajectory/step");
  if (step[begin + 1] - step[begin] != 1) {
    throw FileError(log.h5.file() +
                    ": does not hold every step (run with time.frame_interval = " + "time.step)");
  }
  q = log.q.middleRows(begin, count);
  qdot = log.qdot.middleRows(begin, count);
  force = log.h5.rows("/forces/thigmotaxis").middleRows(begin, count);
  start = log.time[begin];
}

/// What is seen of the body after a step.
struct Seen {
  double head_end = NAN;    ///< arc length of the first touching contact, cm; nan without one
  double penetration = 0;   ///< of the spline skin, as the core measures it, cm
  Eigen::Matrix3Xd centre;  ///< cm
};

Seen look(const Model& model, const Scene& scene, const State& state) {
  const Situation situation = observe(model, state, scene);
  Seen seen{NAN, situation.penetration, situation.kin.centre};
  for (const Contact& contact : situation.contact.contacts) {
    if (contact.gap <= scene.controller.contact_gap) {
      seen.head_end = contact.arc_a;
      break;  // sorted from the head
    }
  }
  return seen;
}

/// MuJoCo with its own contacts and limits (but for cones, which it has not), its head clamped,
/// driven through a slide.
class Player {
 public:
  Player(const LogContents& log, const Slide& slide)
      : model_(log.model),
        scene_(log.resolved.scene),
        slide_(slide),
        mirror_(mjcf_files(log.model, scene_.contact.least_arc, scene_.time.step, Head::clamped)) {}

  void restart(Eigen::Index step) {
    mj_resetData(mirror_.model(), mirror_.data());
    set_state(model_, slide_.state(step), mirror_);
  }
  /// One step under f_thigmo of the log's step (or none) and the scene's drag.
  void step(Eigen::Index step, bool driven) {
    const mjModel& m = *mirror_.model();
    const State state = state_of(model_, mirror_);
    const Kinematics kin = kinematics(model_, state);
    Eigen::VectorXd force = drag_force(model_, kin, state.qdot);
    if (driven) force += slide_.force.row(step).transpose();
    mju_copy(mirror_.data()->qfrc_applied, force.data() + (model_.nv() - m.nv), m.nv);
    mj_step(mirror_.model(), mirror_.data());
    check_stable(mirror_);
  }
  State state() const { return state_of(model_, mirror_); }
  /// Deepest overlap of MuJoCo's capsules at the start of the last step, cm.
  double capsule_penetration() const {
    double deepest = 0;
    for (int i = 0; i < mirror_.data()->ncon; ++i) {
      deepest = std::max(deepest, -mirror_.data()->contact[i].dist);
    }
    return deepest;
  }

 private:
  const Model& model_;
  const Scene& scene_;
  const Slide& slide_;
  MujocoModel mirror_;
};

/// One playback of the whole slide, a row a step; nan from where MuJoCo blew up to the restart.
struct Playback {
  Eigen::VectorXd head_end, log_head_end, drift, penetration, capsule_penetration;
  Eigen::VectorXd determinant;    ///< nan where not looked at
  double slid = 0, log_slid = 0;  ///< headward, over the stretches between restarts, cm
  int looks = 0, held = 0;        ///< at the knot type
  int blown_up = 0;               ///< stretches
};

Playback play(const LogContents& log, const Slide& slide, const std::vector<Seen>& logged,
              double interval, bool driven) {
  const Scene& scene = log.resolved.scene;
  const auto every = [&](double time) {
    return std::max<Eigen::Index>(1, std::llround(time / scene.time.step));
  };
  const Eigen::Index stretch = every(interval);
  Player player(log, slide);
  Playback result;
  const Eigen::VectorXd nothing = Eigen::VectorXd::Constant(slide.steps(), NAN);
  for (Eigen::VectorXd* series :
       {&result.head_end, &result.log_head_end, &result.drift, &result.penetration,
        &result.capsule_penetration, &result.determinant}) {
    *series = nothing;
  }
  bool stable = true;
  for (Eigen::Index i = 0; i < slide.steps(); ++i) {
    if (i % stretch == 0) {
      player.restart(i);
      stable = true;
    }
    result.log_head_end[i] = logged[i + 1].head_end;
    if (!stable) continue;
    try {
      player.step(i, driven);
    } catch (const StepError&) {
      stable = false;
      ++result.blown_up;
      continue;
    }
    const Seen seen = look(log.model, scene, player.state());
    result.head_end[i] = seen.head_end;
    result.penetration[i] = seen.penetration;
    result.capsule_penetration[i] = player.capsule_penetration();
    result.drift[i] = (seen.centre - logged[i + 1].centre).colwise().norm().maxCoeff();
    if ((i + 1) % every(knot_interval) == 0) {
      const KnotInvariants type = knot_type(seen.centre, scene.knot).type;
      result.determinant[i] = type.determinant;
      ++result.looks;
      result.held += knot_name(type) == scene.expect.knot ? 1 : 0;
    }
    if ((i + 1) % stretch == 0 || i + 1 == slide.steps()) {
      const double from = logged[i / stretch * stretch].head_end;
      result.slid += from - seen.head_end;
      result.log_slid += from - logged[i + 1].head_end;
    }
  }
  return result;
}

double largest(const Eigen::VectorXd& values) {
  double found = 0;
  for (const double value : values) found = std::max(found, std::isnan(value) ? 0 : value);
  return found;
}

void write(const Playback& p, const std::string& group, Hdf5Writer& h5) {
  h5.group(group);
  h5.numbers(group + "/head_end", p.head_end,
             {"cm", "arc length of the first touching contact after each step in MuJoCo"});
  h5.numbers(group + "/drift", p.drift, {"cm", "largest distance of a body's centre to the log"});
  h5.numbers(group + "/penetration", p.penetration,
             {"cm", "deepest overlap of the skin along the spline"});
  h5.numbers(group + "/capsule_penetration", p.capsule_penetration,
             {"cm", "deepest overlap of MuJoCo's capsules"});
  h5.numbers(group + "/determinant", p.determinant,
             {"1", "knot determinant of the centreline, nan where not looked at"});
}

void print_row(const Playback& p, bool driven, double interval) {
  fmt::print("{:<12} {:>8g} {:>10.2f} {:>10.2f} {:>10.3f} {:>5}/{:<5} {:>8.3f} {:>8.3f} {:>4}\n",
             driven ? "f_thigmo" : "none", interval, p.slid, p.log_slid, largest(p.drift), p.held,
             p.looks, largest(p.penetration), largest(p.capsule_penetration), p.blown_up);
  std::fflush(stdout);
}

}  // namespace

int playback(const PlaybackOptions& options) {
  const LogContents log(options.log);
  const Slide slide(log);
  std::vector<Seen> logged;
  for (Eigen::Index i = 0; i <= slide.steps(); ++i) {
    logged.push_back(look(log.model, log.resolved.scene, slide.state(i)));
  }
  Hdf5Writer h5;
  h5.root_attribute("log", options.log);
  h5.root_attribute("command", options.command);
  const double h = log.resolved.scene.time.step;
  Eigen::VectorXd time(slide.steps()), head_end(slide.steps());
  for (Eigen::Index i = 0; i < slide.steps(); ++i) {
    time[i] = slide.start + static_cast<double>(i + 1) * h;
    head_end[i] = logged[i + 1].head_end;
  }
  h5.numbers("/time", time, {"s", "end of each step of the sliding phase"});
  h5.numbers("/head_end", head_end, {"cm", "arc length of the first touching contact in the log"});
  if (!log.model.cones.empty()) {
    fmt::print("without bending limits: MuJoCo knows none on the total angle of a joint\n");
  }
  fmt::print("{:<12} {:>8} {:>10} {:>10} {:>10} {:>11} {:>8} {:>8} {:>4}\n", "driven by", "restart",
             "slid", "log slid", "drift", "knot held", "overlap", "capsules", "blew");
  for (const bool driven : {true, false}) {
    for (const double interval : intervals) {
      const Playback result = play(log, slide, logged, interval, driven);
      print_row(result, driven, interval);
      write(result, fmt::format("/{}_{:g}s", driven ? "thigmotaxis" : "none", interval), h5);
    }
  }
  h5.save(options.out);
  return 0;
}

}  // namespace hagfish
