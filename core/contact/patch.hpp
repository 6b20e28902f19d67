// The outermost part of the contact of the body with itself, as an area of skin.
#pragma once

#include <vector>

#include "core/contact/contact.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// Lists the segments that may touch segment `own` of the body, and whose gap to it may be less
/// than `gap` (cm): those on the side of the tail, or of the head (`tail`).
void list_near(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
               bool tail, int own, double gap, std::vector<int>& near);

/// A pair of points that touch, and its share in the patch.
struct PatchPoint {
  Contact contact;
  double share = 0;
};

/// Pairs of points that touch: each pair with gap < controller.contact_gap counts with the weight
/// (1 - gap / contact_gap) ds_a ds_b. From the head end (`tail`: the tail end) of the contact
/// inwards, the patch collects pairs until the weights sum to contact_patch², or all that there
/// are. `end` is the first (last) contact of TouchingEnds. So means over the patch move
/// continuously with the body, where the end itself may jump. Writes points a few to a segment into
/// `patch`; their shares add up to 1. The patch is empty where none of them touch, and where
/// contact_patch is 0. `near` is storage.
void contact_patch(const std::vector<SplineSegment>& segments, const Scene& scene,
                   const Contact& end, bool tail, std::vector<int>& near,
                   std::vector<PatchPoint>& patch);

}  // namespace hagfish
