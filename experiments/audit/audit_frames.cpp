#include "experiments/audit/audit_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/log/log_writer.hpp"

namespace hagfish {
namespace {

/// So many minima more or less, at such a share of the frames.
constexpr std::int64_t most_contacts_off = 6;
constexpr double largest_share_off = 0.2;
/// The first and the last contact follow from q, up to how far Newton's method finds them, in
/// segments of the spline. A search that sees a minimum late may make them others, at up to this
/// share of the frames.
constexpr double found_tolerance = 1e-5;
constexpr double largest_share_late = 0.002;
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

}  // namespace

Steps::Steps(const LogContents& log)
    : stride(frame_stride(log.resolved.scene.time)),
      count(static_cast<std::int64_t>(log.h5.shape("/steps/kkt").at(0))) {}

FrameAudit::FrameAudit(const LogContents& log)
    : log_(log),
      steps_(log),
      contacts_(log.h5.integers("/diagnostics/contacts")),
      bearing_(logged_contacts(log)),
      left_out_(log.h5.doubles("/steps/left_out")),
      spline_a_(log.h5.rows("/thigmotaxis/spline_a")),
      spline_b_(log.h5.rows("/thigmotaxis/spline_b")) {}

void FrameAudit::see(const AuditedFrame& frame) {
  see_ends(frame);
  see_contacts(frame);
  see_motion(frame);
}

void FrameAudit::see_ends(const AuditedFrame& frame) {
  const TouchingEnds& ends = frame.observation.ends;
  for (int place = 0; place < 2; ++place) {
    const double a = spline_a_(frame.index, place);
    followed_ += std::isnan(a) ? 0 : 1;
    const double b = spline_b_(frame.index, place);
    late_ += is_contact(place == 0 ? ends.first : ends.last, a, b) ? 0 : 1;
  }
}

void FrameAudit::see_contacts(const AuditedFrame& frame) {
  const std::int64_t logged = contacts_[static_cast<std::size_t>(frame.index)];
  auto found = static_cast<std::int64_t>(frame.observation.contact.contacts.size());
  if (found != logged) found = minima_by(bearing_, frame, log_);
  contacts_off_by_ = std::max(contacts_off_by_, std::abs(logged - found));
  contacts_off_ += logged == found ? 0 : 1;
  ++frames_;
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

std::vector<Finding> FrameAudit::findings() const {
  // At one frame more or less, whatever the share.
  const auto share = [](std::int64_t count, double most, std::int64_t of) {
    return static_cast<double>(count) / std::max(1.0, most * static_cast<double>(of));
  };
  const double off = std::max(static_cast<double>(contacts_off_by_) / most_contacts_off,
                              share(contacts_off_, largest_share_off, frames_));
  return {
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
