#include "experiments/mujoco/studies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/chain/dynamics.hpp"
#include "core/control/controller.hpp"
#include "core/log/reading/logged_run.hpp"
#include "mujoco_ref/mirror.hpp"

namespace hagfish {
namespace {

/// Times between restarts from the log, s.
constexpr std::array<double, 5> intervals = {0.04, 0.1, 0.2, 0.5, 1.0};

/// The sliding phase of a log, frame by frame.
struct LoggedSlide {
  /// Throws FileError where the knot does not slide for two frames, or the log has no means.
  explicit LoggedSlide(const LogContents& log);
  State state(Eigen::Index frame) const { return {q.row(frame), qdot.row(frame)}; }
  /// Stretches of time between two frames.
  Eigen::Index gaps() const { return q.rows() - 1; }
  /// Mean f_thigmo from a frame to the next, nv.
  auto force(Eigen::Index frame) const { return mean_force.row(frame + 1).transpose(); }
  /// Frames between restarts. Throws FileError where `interval` (s) is no whole number of them.
  Eigen::Index frames_in(double interval) const;
  std::string file;
  Hdf5Reader::Rows q, qdot, mean_force;  ///< a row a frame; the mean since the frame before
  std::vector<double> time;              ///< s, of each frame
  std::int64_t steps = 0;                ///< from frame to frame
  double step = 0;                       ///< h, s
};

LoggedSlide::LoggedSlide(const LogContents& log) {
  require_own_steps(log.h5);
  const auto slides = [](std::int64_t phase) { return phase == static_cast<int>(Phase::slide); };
  const auto first = std::find_if(log.phase.begin(), log.phase.end(), slides);
  const auto last = std::find_if_not(first, log.phase.end(), slides);
  const auto begin = first - log.phase.begin();
  // The state at the end may come sooner after the frame before than others do.
  const auto count = std::min(last - first, static_cast<std::ptrdiff_t>(log.begun - begin));
  if (count < 2) {
    throw FileError(log.h5.file() + ": has no slide of the knot");
  }
  const std::vector<std::int64_t> index = log.h5.integers("/trajectory/step");
  const Hdf5Reader::Rows means = log.h5.rows("/mean/forces/thigmotaxis");
  if (means.rows() != log.qdot.rows() || means.cols() != log.qdot.cols()) {
    throw FileError(log.h5.file() +
                    ": /mean/forces/thigmotaxis does not have the shape of its model and frames");
  }
  file = log.h5.file();
  q = log.q.middleRows(begin, count);
  qdot = log.qdot.middleRows(begin, count);
  mean_force = means.middleRows(begin, count);
  time.assign(log.time.begin() + begin, log.time.begin() + begin + count);
  steps = index[begin + 1] - index[begin];
  step = log.resolved.scene.time.step;
}

Eigen::Index LoggedSlide::frames_in(double interval) const {
  const double frame_interval = static_cast<double>(steps) * step;
  const double frames = interval / frame_interval;
  const double whole = std::round(frames);
  // Both are decimal fractions of a second that a double does not hold exactly.
  if (whole < 1 || std::abs(frames - whole) > 1e-9 * frames) {
    throw FileError(fmt::format(
        "{}: restarts every {:g} s do not fall on its frames, one every {:g} s (run with "
        "time.frame_interval = 0.02)",
        file, interval, frame_interval));
  }
  return static_cast<Eigen::Index>(whole);
}

/// What is seen of the body after a step.
struct Seen {
  double head_end = NAN;    ///< of the knot, cm of arc; nan without contact
  double tail_end = NAN;    ///< likewise
  double penetration = 0;   ///< of the spline skin, as the core measures it, cm
  Eigen::Matrix3Xd centre;  ///< cm
};

Seen look(const Model& model, const Scene& scene, const State& state) {
  const Observation observation = observe(model, state, scene);
  const bool touches = observation.ends.first.has_value();
  return {touches ? observation.ends.head_end : NAN, touches ? observation.ends.tail_end : NAN,
          observation.penetration, observation.kin.centre};
}

/// MuJoCo with its own contacts and limits (but for cones, which it has not), its head clamped,
/// driven through a slide.
class Player {
 public:
  Player(const LogContents& log, const LoggedSlide& slide)
      : model_(log.model),
        scene_(log.resolved.scene),
        slide_(slide),
        mirror_(mjcf_files(log.model, scene_.contact.least_arc, scene_.time.step, Head::clamped)) {}

  void restart(Eigen::Index frame) {
    mj_resetData(mirror_.model(), mirror_.data());
    set_state(model_, slide_.state(frame), mirror_);
  }
  /// To the next frame under its mean f_thigmo (or none) and the scene's drag.
  void advance(Eigen::Index frame, bool driven) {
    const mjModel& m = *mirror_.model();
    capsule_penetration_ = 0;
    for (std::int64_t i = 0; i < slide_.steps; ++i) {
      const State now = state();
      Eigen::VectorXd force = drag_force(model_, kinematics(model_, now), now.qdot);
      if (driven) force += slide_.force(frame);
      mju_copy(mirror_.data()->qfrc_applied, force.data() + (model_.nv() - m.nv), m.nv);
      mj_step(mirror_.model(), mirror_.data());
      check_stable(mirror_);
      for (int c = 0; c < mirror_.data()->ncon; ++c) {
        capsule_penetration_ = std::max(capsule_penetration_, -mirror_.data()->contact[c].dist);
      }
    }
  }
  State state() const { return state_of(model_, mirror_); }
  /// Deepest overlap of MuJoCo's capsules at the start of any step since the frame before, cm.
  double capsule_penetration() const { return capsule_penetration_; }

 private:
  const Model& model_;
  const Scene& scene_;
  const LoggedSlide& slide_;
  MujocoModel mirror_;
  double capsule_penetration_ = 0;
};

/// One playback of the whole slide, a row for each frame but the first; nan from where MuJoCo blew
/// up to the restart.
struct Playback {
  Eigen::VectorXd head_end, tail_end, drift, penetration, capsule_penetration;
  Eigen::VectorXd determinant;
  double slid = 0, log_slid = 0;  ///< headward, over the stretches between restarts, cm
  int samples = 0, kept = 0;      ///< at the knot type
  int blown_up = 0;               ///< stretches
};

Playback play(const LogContents& log, const LoggedSlide& slide, const std::vector<Seen>& logged,
              double interval, bool driven) {
  const Scene& scene = log.resolved.scene;
  const Eigen::Index stretch = slide.frames_in(interval);
  Player player(log, slide);
  Playback result;
  for (Eigen::VectorXd* series :
       {&result.head_end, &result.tail_end, &result.drift, &result.penetration,
        &result.capsule_penetration, &result.determinant}) {
    series->setConstant(slide.gaps(), NAN);
  }
  bool stable = true;
  for (Eigen::Index i = 0; i < slide.gaps(); ++i) {
    if (i % stretch == 0) {
      player.restart(i);
      stable = true;
    }
    if (!stable) continue;
    try {
      player.advance(i, driven);
    } catch (const StepError&) {
      stable = false;
      ++result.blown_up;
      continue;
    }
    const Seen seen = look(log.model, scene, player.state());
    result.head_end[i] = seen.head_end;
    result.tail_end[i] = seen.tail_end;
    result.penetration[i] = seen.penetration;
    result.capsule_penetration[i] = player.capsule_penetration();
    result.drift[i] = (seen.centre - logged[i + 1].centre).colwise().norm().maxCoeff();
    const KnotInvariants type = knot_type(seen.centre, scene.knot).type;
    result.determinant[i] = type.determinant;
    ++result.samples;
    result.kept += knot_name(type) == scene.expect.knot ? 1 : 0;
    if ((i + 1) % stretch == 0 || i + 1 == slide.gaps()) {
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
             {"cm", "arc length of the knot's head end in MuJoCo"});
  h5.numbers(group + "/tail_end", p.tail_end,
             {"cm", "arc length of the knot's tail end in MuJoCo"});
  h5.numbers(group + "/drift", p.drift, {"cm", "largest distance of a body's centre to the log"});
  h5.numbers(group + "/penetration", p.penetration,
             {"cm", "deepest overlap of the skin along the spline"});
  h5.numbers(group + "/capsule_penetration", p.capsule_penetration,
             {"cm", "deepest overlap of MuJoCo's capsules at any step since the frame before"});
  h5.numbers(group + "/determinant", p.determinant, {"1", "knot determinant of the centreline"});
}

void print_row(const Playback& p, bool driven, double interval) {
  fmt::print("{:<12} {:>8g} {:>10.2f} {:>10.2f} {:>10.3f} {:>5}/{:<5} {:>8.3f} {:>8.3f} {:>4}\n",
             driven ? "f_thigmo" : "none", interval, p.slid, p.log_slid, largest(p.drift), p.kept,
             p.samples, largest(p.penetration), largest(p.capsule_penetration), p.blown_up);
  std::fflush(stdout);
}

}  // namespace

void playback(const LogContents& log, Hdf5Writer& h5) {
  const LoggedSlide slide(log);
  std::vector<Seen> logged;
  for (Eigen::Index i = 0; i <= slide.gaps(); ++i) {
    logged.push_back(look(log.model, log.resolved.scene, slide.state(i)));
  }
  for (const double interval : intervals) slide.frames_in(interval);  // before any work
  Eigen::VectorXd time(slide.gaps() + 1), head_end(slide.gaps() + 1), tail_end(slide.gaps() + 1);
  for (Eigen::Index i = 0; i <= slide.gaps(); ++i) {
    time[i] = slide.time[i];
    head_end[i] = logged[i].head_end;
    tail_end[i] = logged[i].tail_end;
  }
  h5.numbers("/time", time, {"s", "frames of the sliding phase; what MuJoCo did has no first"});
  h5.numbers("/head_end", head_end, {"cm", "arc length of the knot's head end in the log"});
  h5.numbers("/tail_end", tail_end, {"cm", "arc length of the knot's tail end in the log"});
  if (!log.model.cones.empty()) {
    fmt::print("without bending limits: MuJoCo has none on the total angle of a joint\n");
  }
  fmt::print("{:<12} {:>8} {:>10} {:>10} {:>10} {:>11} {:>8} {:>8} {:>4}\n", "driven by", "restart",
             "slid", "log slid", "drift", "knot kept", "overlap", "capsules", "blew");
  for (const bool driven : {true, false}) {
    for (const double interval : intervals) {
      const Playback result = play(log, slide, logged, interval, driven);
      print_row(result, driven, interval);
      write(result, fmt::format("/{}_{:g}s", driven ? "thigmotaxis" : "none", interval), h5);
    }
  }
}

}  // namespace hagfish
