// Where the body begins and ends to touch itself: the knot's first and last contact.
#pragma once

#include <optional>
#include <vector>

#include "core/contact/contact.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// The first contact is the smallest s_a, the last one the largest s_b, at which the gap to the
/// nearest point of the other strand is no more than `gap` (ControllerSettings::contact_gap). They
/// move as the body does: unlike minima of the gap, which hop along a strand from joint to joint,
/// where such a level set ends is continuous, and it settles as bodies become more.
struct TouchingEnds {
  std::optional<Contact> first, last;  ///< both or none
};

/// `contacts` are the local minima of the gap of `segments`. Each part of the level set holds one
/// that is no larger, so that from the outermost of these it goes on without a break.
TouchingEnds touching_ends(const std::vector<SplineSegment>& segments,
                           const std::vector<Contact>& contacts, const ContactSettings& settings,
                           double gap);

}  // namespace hagfish
