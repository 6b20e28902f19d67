// Where the body begins and ends to touch itself: the knot's first and last contact.
#pragma once

#include <optional>
#include <vector>

#include "core/contact/contact.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// The first contact is at the smallest s_a, and the last one at the largest s_b, at which the gap
/// to the nearest point of the other strand is at most `gap` (ControllerSettings::contact_gap).
/// These places move continuously with the body, and they converge as bodies become more. Minima of
/// the gap do not: they hop along a strand from joint to joint.
struct TouchingEnds {
  std::optional<Contact> first, last;  ///< both or none
};

/// `contacts` are the local minima of the gap of `segments`. Each part of the level set contains a
/// minimum whose gap is at most `gap`. So the search starts at the outermost of these minima and
/// follows the level set from there.
TouchingEnds touching_ends(const std::vector<SplineSegment>& segments,
                           const std::vector<Contact>& contacts, const ContactSettings& settings,
                           double gap);

}  // namespace hagfish
