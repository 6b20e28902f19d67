#include "experiments/judge/knot_judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/chain/skin_fold.hpp"
#include "core/input/run_time_text.hpp"
#include "core/knot/knot.hpp"
#include "core/knot/writhe.hpp"

namespace hagfish {
namespace {

std::string type_name(const Eigen::Matrix3Xd& centreline, const KnotSettings& settings) {
  try {
    return knot_name(knot_type(centreline, settings).type);
  } catch (const std::domain_error&) {
    return "";
  } catch (const std::overflow_error&) {
    return "";
  }
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

}  // namespace

KnotJudge::KnotJudge(const Model& model, const Scene& scene, bool branch)
    : model_(model), scene_(scene), branch_(branch), slides_(model) {
  const auto plane = std::ranges::find(model.obstacles, scene.expect.out_of, &Obstacle::name);
  if (plane != model.obstacles.end()) out_of_ = plane->plane();
}

void KnotJudge::see(const RunFrame& frame, const Kinematics& kin) {
  Seen& seen = frames_.emplace_back();
  seen.time = frame.time;
  seen.phase = frame.phase;
  seen.type = type_name(kin.centre, scene_.knot);
  if (out_of_ != nullptr) {
    seen.before = out_of_->normal.dot(frame.q.head<3>() - out_of_->point);
  }
  slides_.see(frame.phase, frame.span, frame.q);
  if (!holds_knot(frame.phase)) return;
  if (held_ == 0 && scene_.expect.hand != Hand::any) first_writhe_ = writhe(kin.centre);
  held_centreline_ = kin.centre;
  const double fold = hagfish::skin_fold(model_, kin);
  ++held_;
  folded_ += fold > 1 ? 1 : 0;
  largest_fold_ = std::max(largest_fold_, fold);
}

KnotJudge::Stretch KnotJudge::stretch(Phase phase) const {
  Stretch found;
  for (const Seen& seen : frames_) {
    if (seen.phase != phase) continue;
    if (std::isnan(found.from)) found.from = seen.time;
    found.to = seen.time;
  }
  return found;
}

const std::string& KnotJudge::type() const {
  const auto held = std::ranges::find_if(frames_, holds_knot, &Seen::phase);
  return held != frames_.end() ? held->type : frames_.back().type;
}

Finding KnotJudge::skin() const {
  const ExpectSettings& expect = scene_.expect;
  std::string text = "the knot is never held";
  if (held_ > 0) {
    text = folded_ > 0
               ? fmt::format("inside of a bend the skin folds into itself at {} of {} frames",
                             folded_, held_)
               : "inside of no bend does the skin fold into itself";
    text += fmt::format(
        "; radius of the skin up to {:.2f} of the radius of curvature, across one diameter",
        largest_fold_);
  }
  if (expect.skin_fold > 0) text += fmt::format(" (at most {:g})", expect.skin_fold);
  return judged(skin_fold_criterion(expect, largest_fold_), text);
}

bool KnotJudge::reaches(Phase phase) const {
  return phase_order(scene_.time.until) >= phase_order(phase) &&
         phase_order(scene_.start.phase) <= phase_order(phase);
}

bool KnotJudge::shows(Phase phase) const {
  return reaches(phase) && phase_order(first_phase()) <= phase_order(phase);
}

/// Of a run that never came to hold the knot.
std::string KnotJudge::never_held() const {
  const std::string& expected = scene_.expect.knot;
  const auto tied = std::ranges::count(frames_, expected, &Seen::type);
  return tied == 0 ? "never tied: no frame with " + a_knot(expected)
                   : fmt::format("never tightened, though {} at {} of {} frames", a_knot(expected),
                                 tied, frames_.size());
}

Finding KnotJudge::held() const {
  const std::string& expected = scene_.expect.knot;
  std::int64_t kept = 0;
  std::string lost;
  for (const Seen& seen : frames_) {
    if (!holds_knot(seen.phase)) continue;
    kept += seen.type == expected ? 1 : 0;
    if (lost.empty() && seen.type != expected) {
      lost = fmt::format(", first {} at {:.3f} s", knot_words(seen.type), seen.time);
    }
  }
  return all_of("knot held", kept, held_, "frames",
                held_ == 0 ? never_held()
                           : fmt::format("{} at {} of {} frames from tightening to release{}",
                                         knot_words(expected), kept, held_, lost));
}

/// When a time of the run came, s: at the first frame or later, infinite where it never did.
double KnotJudge::clock_of(const RunTime& time) const {
  if (!time.after) return time.time;
  const int order = phase_order(*time.after);
  for (const Seen& seen : frames_) {
    if (phase_order(seen.phase) >= order) return seen.time + time.time;
  }
  return INFINITY;
}

/// expect.types, where the run gets that far.
std::vector<Finding> KnotJudge::types_through_time() const {
  const double begins = frames_.front().time, ends = frames_.back().time;
  std::vector<Finding> findings;
  for (const KnotStretch& stretch : scene_.expect.types) {
    const double from = clock_of(stretch.from), to = clock_of(stretch.to);
    if ((scene_.time.until != Phase::free && from > ends) || (to <= begins && branch_)) continue;
    std::int64_t frames = 0, kept = 0;
    for (const Seen& seen : frames_) {
      // At the very start of a phase the type may have changed already.
      const bool before_end = stretch.to.after ? seen.time < to : seen.time <= to;
      if (seen.time >= from && before_end) {
        ++frames;
        kept += seen.type == stretch.type ? 1 : 0;
      }
    }
    const std::string what =
        frames > 0 ? fmt::format("{} at {} of {} frames", knot_words(stretch.type), kept, frames)
                   : fmt::format("the log, of {:g} to {:g} s, has no frame with {}", begins, ends,
                                 a_knot(stretch.type));
    const auto told = [this](const RunTime& time, double clock) {
      const std::string text = run_time_text(time);
      if (time.after && phase_order(first_phase()) > phase_order(*time.after)) {
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

/// The sign of the writhe as the knot is first and last held. In between it keeps its hand as it
/// keeps its type, which each frame shows.
Finding KnotJudge::hand() const {
  const bool right = scene_.expect.hand == Hand::right;
  const char* bound = right ? "above 0" : "below 0";
  if (held_ == 0) return {"hand", false, never_held(), "", bound, "writhe"};
  const double last = writhe(held_centreline_);
  const double worst = right ? std::min(first_writhe_, last) : std::max(first_writhe_, last);
  return {"hand",
          right ? worst > 0 : worst < 0,
          fmt::format("writhe {:.2f} as it is first held, {:.2f} as it is last ({} for a {}-handed "
                      "knot)",
                      first_writhe_, last, bound, right ? "right" : "left"),
          fmt::format("{}", worst),
          bound,
          "writhe"};
}

/// Whether the animal itself let go of what holds its head, before a frame: it pulled for as long
/// as food.hold says. What gives ends the pull earlier.
bool KnotJudge::let_go(std::size_t before) const {
  double first = frames_[before].time;
  double last = first;
  for (std::size_t f = before; f-- > 0;) {
    if (frames_[f].phase != Phase::pull) continue;
    if (last == frames_[before].time) last = frames_[f].time;
    first = frames_[f].time;
  }
  return scene_.food.hold > 0 && last - first > scene_.food.hold - 2 * scene_.time.frame_interval;
}

/// The head's end comes back through the plane expect.out_of. Until then the knot is tied, and the
/// animal does not let go of what holds its head.
Finding KnotJudge::head_out() const {
  const ExpectSettings& expect = scene_.expect;
  bool was_in = false;
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    const Seen& seen = frames_[f];
    was_in = was_in || seen.before < 0;
    const bool tied = seen.type == expect.knot;
    if (was_in && phase_order(seen.phase) > phase_order(Phase::form) &&
        (seen.before > 0 || !tied)) {
      const bool of_itself = let_go(f);
      return {
          "head out",
          tied && !of_itself,
          fmt::format("{} at {:.2f} s, with {}{}; its end is {:.2f} cm in front of the {}",
                      tied ? "it came" : "the knot was gone", seen.time, a_knot(seen.type),
                      of_itself ? ", after the animal had let go" : "", seen.before, expect.out_of),
          fmt::format("{}", seen.before),
          "0",
          "cm"};
    }
  }
  return {"head out", false, "it never came in front of the " + expect.out_of, "", "0", "cm"};
}

std::vector<Finding> KnotJudge::findings() const {
  const ExpectSettings& expect = scene_.expect;
  if (expect.knot.empty()) return {};
  const bool shows_knot =
      reaches(Phase::tighten) && phase_order(first_phase()) < phase_order(Phase::release);
  const std::string &first = frames_.front().type, &last = frames_.back().type;
  std::vector<Finding> findings;
  const auto append = [&findings](const std::vector<Finding>& more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  if (shows_knot) findings.push_back(held());
  if (scene_.start.phase == Phase::form && !branch_) {
    findings.push_back({"unknot at start", first == "0_1", knot_words(first), first, "0_1", ""});
  }
  if (reaches(Phase::free)) {
    const bool ended = frames_.back().phase == Phase::free;
    findings.push_back(
        {"unknot at end", ended && last == "0_1",
         knot_words(last) + (ended ? "" : ", but the run ended before the knot was off"), last,
         "0_1", ""});
  }
  append(types_through_time());
  if (shows_knot && expect.hand != Hand::any) findings.push_back(hand());
  if (shows(Phase::slide)) {
    const Slide slide = slides_.slide();
    append(
        moved(slide_criteria(scene_, slide, !begins_within(Phase::slide)), slide, BodyEnd::head));
  }
  if (shows(Phase::reverse) && !begins_within(Phase::reverse) &&
      scene_.controller.leave_by == BodyEnd::tail) {
    const Slide back = slides_.way_back();
    append(moved(way_back_criteria(scene_, back), back, BodyEnd::tail));
  }
  if (out_of_ != nullptr && reaches(Phase::free)) findings.push_back(head_out());
  return findings;
}

}  // namespace hagfish
