// The outermost part of the contact of the body with itself, as an area of skin.
#pragma once

#include <vector>

#include "core/contact/contact.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// A pair of points that touch, and its share in the patch.
struct PatchPoint {
  Contact contact;
  double share = 0;
};

/// Two strands touch where their gap is below controller.contact_gap, by 1 - gap / contact_gap of
/// each area ds_a ds_b. The patch is the outermost part of this area, contact_patch² of it, or all
/// that there is. It begins at the head end (`tail`: at the tail end) of the contact; `end` is the
/// first (last) contact of TouchingEnds. So means over it move continuously with the body, where
/// the end itself may jump. Writes points a few to a segment into `patch`; their shares add up to
/// 1. The patch is empty where none of them touch, and where contact_patch is 0.
void contact_patch(const std::vector<SplineSegment>& segments, const Scene& scene,
                   const Contact& end, bool tail, std::vector<PatchPoint>& patch);

}  // namespace hagfish
