// The knot's first and last contact: where the body begins and ends to touch itself.
#pragma once

#include <optional>
#include <vector>

#include "core/contact/contact.hpp"
#include "core/contact/patch.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// The first contact is at the smallest s_a, and the last one at the largest s_b, at which the gap
/// to the nearest point of the other strand is at most ControllerSettings::contact_gap. These
/// places converge as bodies become more. They move continuously with the body, and jump only where
/// a part of it begins or ceases to touch. Minima of the gap hop along a strand from joint to
/// joint.
struct TouchingEnds {
  std::optional<Contact> first, last;  ///< both or none
  double head_end = 0, tail_end = 0;   ///< the knot's end_arc at both, cm; 0 where there are none
};

/// The patches of contact that begin at both ends (patch.hpp).
struct EndPatches {
  std::vector<PatchPoint> first, last;
  std::vector<int> near;  ///< storage: segments near a point of the last search
};

/// `contacts` are the local minima of the gap of `segments`. Each part of the level set contains a
/// minimum whose gap is at most controller.contact_gap. So the search starts at the outermost of
/// these minima and follows the level set from there. Writes the ends' `patches`, too.
TouchingEnds touching_ends(const std::vector<SplineSegment>& segments,
                           const std::vector<Contact>& contacts, const Scene& scene,
                           EndPatches& patches);

/// The place of an end of the knot on its own strand, cm of arc: the mean over the patch of contact
/// that begins at `end`, or that of `end` itself where the patch is empty.
double end_arc(const Contact& end, const std::vector<PatchPoint>& patch, bool tail);

}  // namespace hagfish
