// Closest points of two segments as core/contact/closest_points.cpp finds them, one pair at a time
// and as one would write it: what its lanes are held to.
#pragma once

#include <optional>

#include "core/contact/closest_points.hpp"

namespace hagfish {

ClosestPoints closest_points_reference(const SplineSegment& a, const SplineSegment& b,
                                       const std::optional<ClosestPoints>& guess = std::nullopt);

}  // namespace hagfish
