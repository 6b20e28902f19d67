#include "experiments/audit/audit_knot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/input/run_time_text.hpp"
#include "core/knot/knot.hpp"
#include "core/knot/writhe.hpp"
#include "core/run/laws.hpp"

namespace hagfish {
namespace {

Phase phase_at(const LogContents& log, std::size_t frame) {
  return static_cast<Phase>(log.phase[frame]);
}

/// A branch begins later than its run.
bool is_branch(const LogContents& log) { return log.h5.has_root_attribute("branched_from"); }

/// The phase that the log begins in.
Phase first_phase(const LogContents& log) {
  return is_branch(log) ? phase_at(log, 0) : log.resolved.scene.start.phase;
}

/// Of a branch that does not show a phase from its beginning.
bool begins_within(const LogContents& log, Phase phase) {
  return is_branch(log) && first_phase(log) == phase;
}

/// Of a run that never came to hold the knot.
std::string never_held(const std::string& expected, const std::vector<std::string>& type) {
  const auto tied = std::ranges::count(type, expected);
  return tied == 0 ? "never tied: no frame with a " + expected
                   : fmt::format("never tightened, though a {} at {} of {} frames", expected, tied,
                                 type.size());
}

Finding held(const LogContents& log, const std::vector<std::string>& type) {
  const std::string& expected = log.resolved.scene.expect.knot;
  std::int64_t frames = 0;
  std::int64_t kept = 0;
  std::string lost;
  for (std::size_t f = 0; f < type.size(); ++f) {
    if (!holds_knot(phase_at(log, f))) {
      continue;
    }
    ++frames;
    kept += type[f] == expected ? 1 : 0;
    if (lost.empty() && type[f] != expected) {
      lost = fmt::format(", first {} at {:.3f} s", type[f], log.time[f]);
    }
  }
  return all_of("knot held", kept, frames, "frames",
                frames == 0 ? never_held(expected, type)
                            : fmt::format("{} at {} of {} frames from tightening to release{}",
                                          expected, kept, frames, lost));
}

/// When a time of the run came, s: at the log's first frame or later, infinite where it never did.
double clock_of(const LogContents& log, const RunTime& time) {
  if (!time.after) return time.time;
  const int order = phase_order(*time.after);
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    if (phase_order(phase_at(log, f)) >= order) return log.time[f] + time.time;
  }
  return INFINITY;
}

/// expect.types, where the run gets that far.
std::vector<Finding> types_through_time(const LogContents& log,
                                        const std::vector<std::string>& type) {
  const Scene& scene = log.resolved.scene;
  std::vector<Finding> findings;
  for (const KnotStretch& stretch : scene.expect.types) {
    const double from = clock_of(log, stretch.from), to = clock_of(log, stretch.to);
    if ((scene.time.until != Phase::free && from > log.time.back()) ||
        (to <= log.time.front() && is_branch(log))) {
      continue;
    }
    std::int64_t frames = 0;
    std::int64_t kept = 0;
    for (std::size_t f = 0; f < type.size(); ++f) {
      // At the very start of a phase the type may have changed already.
      const bool before_end = stretch.to.after ? log.time[f] < to : log.time[f] <= to;
      if (log.time[f] >= from && before_end) {
        ++frames;
        kept += type[f] == stretch.type ? 1 : 0;
      }
    }
    const std::string what =
        frames > 0 ? fmt::format("{} at {} of {} frames", stretch.type, kept, frames)
                   : fmt::format("the log, of {:g} to {:g} s, has no frame to be a {}",
                                 log.time.front(), log.time.back(), stretch.type);
    const auto told = [&log](const RunTime& time, double clock) {
      const std::string text = run_time_text(time);
      if (time.after && phase_order(first_phase(log)) > phase_order(*time.after)) {
        return text + " (before the log)";
      }
      return time.after && std::isfinite(clock) ? fmt::format("{} ({:g} s)", text, clock)
             : time.after || std::isinf(clock)  ? text
                                                : text + " s";
    };
    findings.push_back(all_of(
        "knot through time", kept, frames, "frames",
        fmt::format("{} from {} to {}", what, told(stretch.from, from), told(stretch.to, to))));
  }
  return findings;
}

/// The sign of the writhe while the knot holds.
Finding hand(const LogContents& log, const std::vector<SeenKnot>& seen,
             const std::vector<std::string>& type) {
  double least = INFINITY;
  double most = -INFINITY;
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    if (holds_knot(phase_at(log, f))) {
      least = std::min(least, seen[f].writhe);
      most = std::max(most, seen[f].writhe);
    }
  }
  const bool right = log.resolved.scene.expect.hand == Hand::right;
  const bool any = least <= most;
  const char* bound = right ? "above 0" : "below 0";
  return {"hand",
          any && (right ? least > 0 : most < 0),
          any ? fmt::format("writhe from {:.2f} to {:.2f} while held ({} for a {}-handed knot)",
                            least, most, bound, right ? "right" : "left")
              : never_held(log.resolved.scene.expect.knot, type),
          any ? fmt::format("{}", right ? least : most) : "",
          bound,
          "writhe"};
}

/// What `criteria`, the way of the leading end and the share of both, say of a slide.
std::vector<Finding> moved(const std::vector<Criterion>& criteria, const Slide& slide,
                           BodyEnd towards) {
  const Criterion &way = criteria.at(0), &both = criteria.at(1);
  if (std::isnan(way.value)) {
    const std::string none = "no " + way.name;
    return {judged(way, fmt::format("{} (at least {:g} cm)", none, way.bound)), judged(both, none)};
  }
  const bool headward = towards == BodyEnd::head;
  return {judged(way, fmt::format("{} end of the knot moved {:.2f} cm {}ward (at least {:g})",
                                  headward ? "head" : "tail", way.value, headward ? "head" : "tail",
                                  way.bound)),
          judged(both, fmt::format("the knot {}: its {} end moved {:.2f} cm of {:.2f} that taper "
                                   "asks, curvature {:.2f} cm "
                                   "(correlation {:.2f}); {:.0f} % (at least {:g} %)",
                                   slide_name(slide), headward ? "tail" : "head",
                                   slide.trailing_way, slide.taper_asks, slide.travel,
                                   slide.correlation, both.value, both.bound))};
}

/// Whether the scene's law asks for Eq. 6 while the knot slides; of a law of the run's own, whether
/// it may.
bool asks_for_eq6(const Scene& scene) {
  const Law& law = law_of(scene);
  return law.rows == nullptr || law.rows(scene, Phase::slide).any;
}

/// Eq. 6 at the steps of both slides; nothing where the law never asks for it. Of a law of the
/// run's own at those steps at which it does. Steps of a phase lie between its frames' first and
/// last step.
std::optional<Finding> commanded_speed(const LogContents& log) {
  if (!log.own_law() && !asks_for_eq6(log.resolved.scene)) return std::nullopt;
  const std::vector<std::int64_t> step = log.h5.integers("/trajectory/step");
  const std::vector<std::int64_t> eq6 = log.h5.integers("/steps/eq6");
  std::int64_t met = 0;
  std::int64_t rows = 0;
  for (std::size_t f = 0; f + 1 < step.size(); ++f) {
    if (phase_at(log, f) != Phase::slide && phase_at(log, f) != Phase::reverse) {
      continue;
    }
    for (std::int64_t k = step[f]; k < step[f + 1]; ++k) {
      const std::int64_t one = eq6.at(k - step.front());
      rows += one != -1 || !log.own_law() ? 1 : 0;
      met += one == 1 ? 1 : 0;
    }
  }
  if (log.own_law() && rows == 0) return std::nullopt;
  const Criterion criterion = eq6_criterion(log.resolved.scene.expect, met, rows);
  return judged(criterion,
                rows == 0 ? fmt::format("no sliding steps (at least {:g} %)", criterion.bound)
                          : fmt::format("met without slack on {:.2f} % of {} sliding steps (at "
                                        "least {:g} %)",
                                        criterion.value, rows, criterion.bound));
}

/// Whether the animal itself let go of what holds its head, before a frame: it pulled for as long
/// as food.hold says. What gives ends the pull earlier.
bool let_go(const LogContents& log, std::size_t before) {
  double first = log.time[before];
  double last = first;
  for (std::size_t f = before; f-- > 0;) {
    if (phase_at(log, f) != Phase::pull) continue;
    if (last == log.time[before]) last = log.time[f];
    first = log.time[f];
  }
  const Scene& scene = log.resolved.scene;
  return scene.food.hold > 0 && last - first > scene.food.hold - 2 * scene.time.frame_interval;
}

/// The head's end comes back through the plane expect.out_of. Until then the knot is tied, and the
/// animal does not let go of what holds its head.
Finding head_out(const LogContents& log, const std::vector<std::string>& type) {
  const ExpectSettings& expect = log.resolved.scene.expect;
  const auto plane = std::ranges::find(log.model.obstacles, expect.out_of, &Obstacle::name);
  bool was_in = false;
  for (std::size_t f = 0; f < type.size(); ++f) {
    const Eigen::Vector3d end = log.q.row(static_cast<Eigen::Index>(f)).head<3>();
    const double before = plane->normal.dot(end - plane->point);  // cm in front of it
    was_in = was_in || before < 0;
    const bool tied = type[f] == expect.knot;
    if (was_in && phase_order(phase_at(log, f)) > phase_order(Phase::form) &&
        (before > 0 || !tied)) {
      const bool of_itself = let_go(log, f);
      return {"head out",
              tied && !of_itself,
              fmt::format("{} at {:.2f} s, with a {}{}; its end is {:.2f} cm in front of the {}",
                          tied ? "it came" : "the knot was gone", log.time[f], type[f],
                          of_itself ? ", after the animal had let go" : "", before, expect.out_of),
              fmt::format("{}", before),
              "0",
              "cm"};
    }
  }
  return {"head out", false, "it never came in front of the " + expect.out_of, "", "0", "cm"};
}

}  // namespace

SlideWatch slides_of(const LogContents& log,
                     const std::function<void(const SlideWatch& so_far)>& seen) {
  const std::vector<double> head = log.h5.doubles("/knot/head_end");
  const std::vector<double> tail = log.h5.doubles("/knot/tail_end");
  SlideWatch watch(log.model);
  for (std::size_t f = 0; f < head.size(); ++f) {
    const bool knotted = !std::isnan(head[f]) && !std::isnan(tail[f]);
    watch.see(phase_at(log, f), knotted ? std::optional(KnotSpan{head[f], tail[f]}) : std::nullopt,
              log.q.row(static_cast<Eigen::Index>(f)));
    if (seen) seen(watch);
  }
  return watch;
}

double largest_muscle_torque(const LogContents& log) {
  const Hdf5Reader::Rows torque =
      log.h5.rows("/mean/forces/active") + log.h5.rows("/mean/forces/thigmotaxis");
  double largest = 0;
  for (Eigen::Index f = 1; f < torque.rows(); ++f) {
    if (!slides_or_pulls(phase_at(log, static_cast<std::size_t>(f - 1)))) continue;
    const double most = torque.row(f).tail(torque.cols() - root_dofs).cwiseAbs().maxCoeff();
    largest = worse(largest, most);
  }
  return largest;
}

SeenKnot see_knot(const LogContents& log, const AuditedFrame& frame) {
  const Eigen::Matrix3Xd& centre = frame.observation.kin.centre;
  const Scene& scene = log.resolved.scene;
  const bool asked = scene.expect.hand != Hand::any && holds_knot(frame.phase);
  return {knot_type(centre, scene.knot), asked ? writhe(centre) : 0};
}

std::vector<Finding> audit_knot(const LogContents& log, const std::vector<SeenKnot>& seen) {
  const Scene& scene = log.resolved.scene;
  const ExpectSettings& expect = scene.expect;
  if (expect.knot.empty()) {
    return {};
  }
  const auto reaches = [&](Phase phase) {
    return phase_order(scene.time.until) >= phase_order(phase) &&
           phase_order(scene.start.phase) <= phase_order(phase);
  };
  // A branch may begin after a phase of its run.
  const auto shows = [&](Phase phase) {
    return reaches(phase) && phase_order(first_phase(log)) <= phase_order(phase);
  };
  const bool shows_knot =
      reaches(Phase::tighten) && phase_order(first_phase(log)) < phase_order(Phase::release);
  std::vector<std::string> type;
  for (const SeenKnot& knot : seen) {
    type.push_back(knot_name(knot.vote.type));
  }
  std::vector<Finding> findings;
  const auto append = [&findings](const std::vector<Finding>& more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  if (shows_knot) {
    findings.push_back(held(log, type));
  }
  if (scene.start.phase == Phase::form && !is_branch(log)) {
    findings.push_back(
        {"unknot at start", type.front() == "0_1", type.front(), type.front(), "0_1", ""});
  }
  if (reaches(Phase::free)) {
    const bool ended = phase_at(log, type.size() - 1) == Phase::free;
    findings.push_back({"unknot at end", ended && type.back() == "0_1",
                        type.back() + (ended ? "" : ", but the run ended before the knot was off"),
                        type.back(), "0_1", ""});
  }
  append(types_through_time(log, type));
  if (shows_knot && expect.hand != Hand::any) {
    findings.push_back(hand(log, seen, type));
  }
  const SlideWatch slides = slides_of(log);
  if (shows(Phase::slide)) {
    const Slide slide = slides.slide();
    append(moved(slide_criteria(scene, slide, !begins_within(log, Phase::slide)), slide,
                 BodyEnd::head));
  }
  if (shows(Phase::reverse) && !begins_within(log, Phase::reverse) &&
      scene.controller.leave_by == BodyEnd::tail) {
    const Slide back = slides.way_back();
    append(moved(way_back_criteria(scene, back), back, BodyEnd::tail));
  }
  if (!expect.out_of.empty() && reaches(Phase::free)) findings.push_back(head_out(log, type));
  if (shows(Phase::slide)) {
    if (const auto finding = commanded_speed(log)) findings.push_back(*finding);
    if (expect.torque_share > 0) {
      findings.push_back(judged_over(torque_criterion(scene, largest_muscle_torque(log)),
                                     "largest of a hinge while the knot slides or pulls"));
    }
  }
  return findings;
}

}  // namespace hagfish
