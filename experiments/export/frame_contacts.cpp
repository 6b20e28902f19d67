#include "experiments/export/frame_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

/// A run's own search finds a minimum to this, cm of arc: nearer ones are the same contact.
constexpr double same_contact = 0.01;

FrameContact of_strands(const Contact& c, const std::vector<SplineSegment>& segments,
                        double force) {
  const SplineSegment& b = segments[c.segment_b];
  const Eigen::Vector3d point = b.point(c.t_b) + (b.radius(c.t_b) + 0.5 * c.gap) * c.normal;
  return {false, c.arc_a, c.arc_b, c.gap, point, c.normal, force};
}

}  // namespace

FrameContacts::FrameContacts(const LogContents& log) : log_(log), bearing_(log.time.size()) {
  const std::vector<std::int64_t> frame = log.h5.integers("/contacts/frame");
  const std::vector<double> a = log.h5.doubles("/contacts/spline_a");
  const std::vector<double> b = log.h5.doubles("/contacts/spline_b");
  const std::vector<double> force = log.h5.doubles("/contacts/force");
  for (std::size_t k = 0; k < frame.size(); ++k) {
    if (!on_spline(log.model, a[k]) || !(std::isnan(b[k]) || on_spline(log.model, b[k]))) {
      throw FileError(
          fmt::format("{}: /contacts has one at {:g} and {:g}, which is beyond its {} "
                      "bodies",
                      log.h5.file(), a[k], b[k], log.model.body_count()));
    }
    bearing_[static_cast<std::size_t>(frame[k])].push_back({a[k], b[k], force[k]});
  }
}

std::vector<FrameContact> FrameContacts::at(const ShownFrame& frame) const {
  const std::vector<SplineSegment>& segments = frame.observation.segments;
  std::vector<FrameContact> found;
  for (const Bearing& one : bearing_[static_cast<std::size_t>(frame.index)]) {
    const auto [segment_a, t_a] = spline_point(log_.model, one.a);
    if (std::isnan(one.b)) {
      const SplineSegment& s = segments[segment_a];
      const double gap = s.point(t_a).x() - s.radius(t_a);
      const Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
      found.push_back({true, s.arc(t_a), NAN, gap,
                       s.point(t_a) - (s.radius(t_a) + 0.5 * gap) * normal, normal, one.force});
    } else {
      const auto [segment_b, t_b] = spline_point(log_.model, one.b);
      found.push_back(
          of_strands(contact_at(segments, segment_a, t_a, segment_b, t_b), segments, one.force));
    }
  }
  const std::size_t bearing = found.size();
  for (const Contact& c : frame.observation.contact.contacts) {
    const auto same = [&c](const FrameContact& other) {
      return std::hypot(c.arc_a - other.arc_a, c.arc_b - other.arc_b) < same_contact;
    };
    if (std::none_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(bearing), same)) {
      found.push_back(of_strands(c, segments, 0));
    }
  }
  std::ranges::stable_sort(found, {}, &FrameContact::arc_a);
  return found;
}

}  // namespace hagfish
