#include "experiments/export/frame_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

/// A run's own search finds a minimum to this, cm of arc: nearer ones are the same contact.
constexpr double same_contact = 0.01;

FrameContact of(const Contact& c, const std::vector<SplineSegment>& segments, double force) {
  const SplineSegment& a = segments[c.segment_a];
  const Eigen::Vector3d point = a.point(c.t_a) - (a.radius(c.t_a) + 0.5 * c.gap) * c.normal;
  return {c.obstacle, c.arc_a, c.obstacle < 0 ? c.arc_b : NAN, c.gap, point, c.normal, force};
}

}  // namespace

FrameContacts::FrameContacts(const LogContents& log) : log_(log), bearing_(log.time.size()) {
  for (const LoggedContact& one : logged_contacts(log)) {
    if (!is_placed(log.model, one)) {
      throw FileError(
          fmt::format("{}: /contacts has a contact at {:g} and {:g}, which is on none of its {} "
                      "bodies and obstacles",
                      log.h5.file(), one.a, one.b, log.model.body_count()));
    }
    bearing_[static_cast<std::size_t>(one.frame)].push_back(one);
  }
}

std::vector<FrameContact> FrameContacts::at(const ShownFrame& frame) const {
  const std::vector<SplineSegment>& segments = frame.observation.segments;
  std::vector<FrameContact> found;
  for (const LoggedContact& one : bearing_[static_cast<std::size_t>(frame.index)]) {
    const Contact contact = placed_contact(log_.model, frame.observation.kin, segments, one);
    found.push_back(of(contact, segments, one.force));
  }
  const std::size_t bearing = found.size();
  const ContactSet& seen = frame.observation.contact;
  for (const std::vector<Contact>* contacts : {&seen.contacts, &seen.on_obstacles}) {
    for (const Contact& c : *contacts) {
      const FrameContact here = of(c, segments, 0);
      const auto same = [&](const FrameContact& other) {
        const double apart_b = c.obstacle < 0 ? c.arc_b - other.arc_b : 0;
        return c.obstacle == other.obstacle &&
               std::hypot(c.arc_a - other.arc_a, apart_b) < same_contact;
      };
      if (std::none_of(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(bearing), same)) {
        found.push_back(here);
      }
    }
  }
  std::ranges::stable_sort(found, {}, &FrameContact::arc_a);
  return found;
}

}  // namespace hagfish
