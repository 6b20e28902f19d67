#include "experiments/audit/audit_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "core/chain/skin_fold.hpp"
#include "core/log/log_writer.hpp"
#include "experiments/audit/row_force.hpp"

namespace hagfish {
namespace {

/// A search that carries its pairs from step to step may see a minimum beside another one late, and
/// with it an overlap that much deeper, of the body's length: 5e-6 at most in built-in scenes and
/// in those that designs found.
constexpr double search_tolerance = 1e-5;
/// So many minima more or less, at such a share of the frames.
constexpr std::int64_t most_contacts_off = 6;
constexpr double largest_share_off = 0.2;
/// The first and the last contact follow from q, up to how far Newton's method finds them, in
/// segments of the spline. A search that sees a minimum late may make them others, at up to this
/// share of the frames.
constexpr double found_tolerance = 1e-5;
constexpr double largest_share_late = 0.002;
/// Figures that are nothing but rounding have no scale of their own, cm and rad.
constexpr double nothing_but_rounding = 1e-9;

/// The centre of mass goes from frame to frame at the mean of its velocities at both, but for what
/// it changes in between: so many lengths of the body a second, or this share of the speed, more
/// where frames are further apart than these, s. Seen: 1.54 cm/s of an animal of 42.4 cm, whose
/// head comes free; one twice as long moves twice as fast. A jump of the speed next to a frame
/// takes half of it, as where a knot comes off.
constexpr double way_tolerance = 0.06;
constexpr double way_share = 0.5;
constexpr double way_interval = 0.02;

/// Whether the contact that the spline parameters `a` and `b` give is `found`, if any.
bool is_contact(const std::optional<Contact>& found, double a, double b) {
  if (!found) return std::isnan(a) && std::isnan(b);
  return std::hypot(found->segment_a + found->t_a - a, found->segment_b + found->t_b - b) <=
         found_tolerance;
}

/// Minima of the gap that a search finds which knows where the log says that strands bear on each
/// other. Where they lie along each other, one from nothing may miss the lower of two minima.
std::int64_t minima_by(const std::vector<LoggedContact>& contacts, const AuditedFrame& frame,
                       const LogContents& log) {
  const std::vector<SplineSegment>& segments = frame.observation.segments;
  const ContactSettings& settings = log.resolved.scene.contact;
  ContactSearch search;
  ContactSet set;
  find_contacts(segments, settings, 0, search, set);
  Candidates& candidates = search.candidates;
  for (const LoggedContact& one : contacts) {
    if (one.frame != frame.index || one.obstacle >= 0 || !is_placed(log.model, one)) continue;
    const auto [a, t_a] = spline_point(log.model, one.a);
    const auto [b, t_b] = spline_point(log.model, one.b);
    if (const int pair = find_pair(candidates, a, b); pair >= 0) {
      candidates.closest[pair] = {t_a, t_b, 0};
    }
  }
  std::ranges::fill(candidates.clear_until, 0);  // all are to be looked at again
  find_contacts(segments, settings, 0, search, set);
  return static_cast<std::int64_t>(set.contacts.size());
}

/// Sum of the integrator's terms of the ledger at each frame, erg.
std::vector<double> sum_of(const LogContents& log, const std::vector<std::string>& terms) {
  std::vector<double> sum(log.time.size(), 0);
  for (const std::string& term : terms) {
    const std::vector<double> values = log.h5.doubles("/diagnostics/integrator_" + term);
    std::transform(sum.begin(), sum.end(), values.begin(), sum.begin(), std::plus<>());
  }
  return sum;
}

}  // namespace

Steps::Steps(const LogContents& log)
    : first(log.h5.integers("/trajectory/step").front()),
      stride(frame_stride(log.resolved.scene.time)),
      count(static_cast<std::int64_t>(log.h5.shape("/steps/kkt").at(0))) {}

FrameAudit::FrameAudit(const LogContents& log)
    : log_(log),
      steps_(log),
      step_(log.h5.integers("/trajectory/step")),
      determinant_(log.h5.integers("/knot/determinant")),
      v2_(log.h5.integers("/knot/v2")),
      contacts_(log.h5.integers("/diagnostics/contacts")),
      bearing_(logged_contacts(log)),
      agreement_(log.h5.doubles("/knot/agreement")),
      head_end_(log.h5.doubles("/knot/head_end")),
      tail_end_(log.h5.doubles("/knot/tail_end")),
      kinetic_(log.h5.doubles("/diagnostics/kinetic_energy")),
      elastic_(log.h5.doubles("/diagnostics/elastic_energy")),
      gravity_(log.h5.doubles("/diagnostics/gravity_energy")),
      integrator_(sum_of(log, {"inertia", "potential", "coriolis", "held", "given_back"})),
      integrator_error_(log.h5.doubles("/diagnostics/integrator_error")),
      skin_fold_(log.h5.doubles("/diagnostics/skin_fold")),
      penetration_(log.h5.doubles("/steps/penetration")),
      left_out_(log.h5.doubles("/steps/left_out")),
      limit_violation_(log.h5.doubles("/steps/limit_violation")),
      head_drift_(log.h5.doubles("/steps/head_drift")),
      position_(log.h5.rows("/trajectory/position")),
      momentum_(log.h5.rows("/diagnostics/momentum")),
      angular_momentum_(log.h5.rows("/diagnostics/angular_momentum")),
      spline_a_(log.h5.rows("/thigmotaxis/spline_a")),
      spline_b_(log.h5.rows("/thigmotaxis/spline_b")),
      last_order_(phase_order(log.resolved.scene.start.phase)) {}

void FrameAudit::see(const AuditedFrame& frame, const KnotVote& knot) {
  see_trajectory(frame);
  see_knot(frame, knot);
  see_fold(frame);
  see_energy(frame);
  see_bounds(frame);
  see_motion(frame);
}

void FrameAudit::see_trajectory(const AuditedFrame& frame) {
  const Eigen::Index f = frame.index;
  const std::int64_t step = steps_.first + steps_.at(f);
  by_itself_.compare_exactly("/trajectory/step", step_[f], step);
  by_itself_.compare("/trajectory/time", log_.time[f],
                     static_cast<double>(step) * log_.resolved.scene.time.step);
  // Phases follow each other.
  const int order = phase_order(frame.phase);
  by_itself_.compare_exactly("/trajectory/phase", order, std::max(order, last_order_));
  last_order_ = std::max(order, last_order_);
  from_q_.compare("/trajectory/position", position_.row(f).transpose(),
                  frame.observation.kin.centre.reshaped());
}

void FrameAudit::see_knot(const AuditedFrame& frame, const KnotVote& knot) {
  const Eigen::Index f = frame.index;
  from_q_.compare_exactly("/knot/determinant", determinant_[f], knot.type.determinant);
  from_q_.compare_exactly("/knot/v2", v2_[f], knot.type.v2);
  from_q_.compare("/knot/agreement", agreement_[f], knot.agreement);
  const std::vector<SplineSegment>& segments = frame.observation.segments;
  const double first = spline_a_(f, 0);
  const double last = spline_b_(f, 1);
  const TouchingEnds& ends = frame.observation.ends;
  for (int place = 0; place < 2; ++place) {
    const double a = spline_a_(f, place);
    followed_ += std::isnan(a) ? 0 : 1;
    late_ += is_contact(place == 0 ? ends.first : ends.last, a, spline_b_(f, place)) ? 0 : 1;
  }
  const bool span = on_spline(log_.model, first) && on_spline(log_.model, last) &&
                    on_spline(log_.model, spline_b_(f, 0)) &&
                    on_spline(log_.model, spline_a_(f, 1));
  const auto end = [&](int place) {
    const Contact at = contact_of(log_.model, segments, spline_a_(f, place), spline_b_(f, place));
    std::vector<PatchPoint> patch;
    contact_patch(segments, log_.resolved.scene, at, place == 1, patch);
    return end_arc(at, patch, place == 1);
  };
  from_q_.compare("/knot/head_end", head_end_[f], span ? end(0) : NAN);
  from_q_.compare("/knot/tail_end", tail_end_[f], span ? end(1) : NAN);
}

void FrameAudit::see_fold(const AuditedFrame& frame) {
  const double fold = skin_fold(log_.model, frame.observation.kin);
  from_q_.compare("/diagnostics/skin_fold", skin_fold_[frame.index], fold);
  if (!holds_knot(frame.phase)) return;
  ++held_;
  folded_ += fold > 1 ? 1 : 0;
  largest_fold_ = std::max(largest_fold_, fold);
}

void FrameAudit::see_energy(const AuditedFrame& frame) {
  const Eigen::Index f = frame.index;
  const Kinematics& kin = frame.observation.kin;
  from_q_.compare("/diagnostics/kinetic_energy", kinetic_[f], kinetic_energy(log_.model, kin));
  from_q_.compare("/diagnostics/elastic_energy", elastic_[f],
                  elastic_energy(log_.model, frame.state.q));
  by_itself_.compare("/diagnostics/integrator_error", integrator_error_[f], integrator_[f]);
  from_q_.compare("/diagnostics/gravity_energy", gravity_[f], gravity_energy(log_.model, kin));
  const Momentum momentum = momentum_of(log_.model, kin);
  from_q_.compare("/diagnostics/momentum", momentum_.row(f).transpose(), momentum.linear);
  from_q_.compare("/diagnostics/angular_momentum", angular_momentum_.row(f).transpose(),
                  momentum.angular);
}

void FrameAudit::see_bounds(const AuditedFrame& frame) {
  const Eigen::Index f = frame.index;
  const Observation& s = frame.observation;
  auto found = static_cast<std::int64_t>(s.contact.contacts.size());
  if (found != contacts_[f]) found = minima_by(bearing_, frame, log_);
  contacts_off_by_ = std::max(contacts_off_by_, std::abs(contacts_[f] - found));
  contacts_off_ += contacts_[f] == found ? 0 : 1;
  ++frames_;
  const double drift = frame.clamped ? head_drift(log_.model, s.kin) : 0;
  if (!frame.begins_step) {
    see_worst_at_end(s, drift);
    return;
  }
  const Eigen::Index step = steps_.at(f);
  from_q_.compare("/steps/penetration", penetration_[step], s.penetration,
                  search_tolerance * log_.model.length());
  from_q_.compare("/steps/limit_violation", limit_violation_[step], s.limit_violation,
                  nothing_but_rounding);
  from_q_.compare("/steps/head_drift", head_drift_[step], drift, nothing_but_rounding);
}

/// Worst figures of the steps since the frame before, and of the state at the end.
void FrameAudit::see_worst_at_end(const Observation& end, double drift) {
  const auto compare = [&](const std::string& path, const std::vector<double>& of_steps, double own,
                           double allowed) {
    const auto since = of_steps.begin() + steps_.at(log_.begun - 1) + 1;
    from_q_.compare(path, log_.h5.doubles(path).back(),
                    std::accumulate(since, of_steps.end(), own, worse), allowed);
  };
  compare("/diagnostics/penetration", penetration_, end.penetration,
          search_tolerance * log_.model.length());
  compare("/diagnostics/limit_violation", limit_violation_, end.limit_violation,
          nothing_but_rounding);
  compare("/diagnostics/head_drift", head_drift_, drift, nothing_but_rounding);
  compare("/diagnostics/kkt_worst", log_.h5.doubles("/steps/kkt"), 0, 0);
}

void FrameAudit::see_motion(const AuditedFrame& frame) {
  const auto mean = [this](const Eigen::Matrix3Xd& of_bodies) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double mass = 0;
    for (int b = 0; b < log_.model.body_count(); ++b) {
      sum += log_.model.bodies[b].mass * of_bodies.col(b);
      mass += log_.model.bodies[b].mass;
    }
    return Eigen::Vector3d(sum / mass);
  };
  const Kinematics& kin = frame.observation.kin;
  const Eigen::Vector3d centre = mean(kin.centre), arrived_with = mean(kin.centre_velocity);
  if (frame.index > 0) {
    const double elapsed = log_.time[frame.index] - log_.time[frame.index - 1];
    const Eigen::Vector3d off =
        centre - centre_before_ - 0.5 * elapsed * (left_with_ + arrived_with);
    const double speed = std::max(left_with_.norm(), arrived_with.norm());
    const double left_out = std::accumulate(left_out_.begin() + steps_.at(frame.index - 1),
                                            left_out_.begin() + steps_.at(frame.index), 0.0);
    const double allowed = elapsed * std::max(1.0, elapsed / way_interval) *
                               std::max(way_tolerance * log_.model.length(), way_share * speed) +
                           left_out * speed;
    off_way_ = worse(off_way_, off.norm() / allowed);
  }
  centre_before_ = centre;
  left_with_ = arrived_with;
}

Finding FrameAudit::skin() const {
  const ExpectSettings& expect = log_.resolved.scene.expect;
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

std::vector<Finding> FrameAudit::findings() const {
  // At one frame more or less, whatever the share.
  const auto share = [](std::int64_t count, double most, std::int64_t of) {
    return static_cast<double>(count) / std::max(1.0, most * static_cast<double>(of));
  };
  const double off = std::max(static_cast<double>(contacts_off_by_) / most_contacts_off,
                              share(contacts_off_, largest_share_off, frames_));
  return {
      by_itself_.finding("frames", "the frame's number, the phase before, the integrator's terms"),
      from_q_.finding("figures of q", "q and q̇ at every frame"),
      skin(),
      judged_over({"motion", off_way_, 1, "of what is allowed"},
                  "way of the centre of mass between frames, against its velocities there"),
      judged({"contacts", off, 1, "of what is allowed"},
             fmt::format("/diagnostics/contacts is not what a search from nothing finds at {} of "
                         "{} frames (at most {:g} %), by {} at most ({})",
                         contacts_off_, frames_, 100 * largest_share_off, contacts_off_by_,
                         most_contacts_off)),
      judged(
          {"contacts followed",
           static_cast<double>(late_) / std::max(1.0, static_cast<double>(followed_)),
           largest_share_late, "of the frames"},
          followed_ == 0
              ? "no contact was followed"
              : fmt::format("/thigmotaxis/spline_a and spline_b are not where the body begins and "
                            "ends to touch itself {} times of {} (at most {:g} %)",
                            late_, followed_, 100 * largest_share_late))};
}

}  // namespace hagfish
