// Contact of the swept skin: where strands of the body touch or nearly touch each other, or a
// strand that is an obstacle.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/contact/candidates.hpp"
#include "core/contact/closest_points.hpp"
#include "core/contact/spline.hpp"

namespace hagfish {

/// One local minimum of the gap between two strands; a is the strand nearer the head, b the other
/// one or an obstacle.
struct Contact {
  int segment_a = 0, segment_b = 0;
  double t_a = 0, t_b = 0;
  double arc_a = 0, arc_b = 0;           ///< arc length from the head, cm; infinite on an obstacle
  double gap = 0;                        ///< cm; negative where the skins overlap
  Eigen::Vector3d normal;                ///< unit, world, from b to a: the gap's rate along ẋ_a
  Eigen::Vector3d tangent_a, tangent_b;  ///< unit, world, both to the tail
  int obstacle = -1;                     ///< that strand b is; -1: the body itself

  /// Body of the chain nearest to the point on strand a (b, where that is of the body).
  int body_a() const { return segment_a + (t_a >= 0.5 ? 1 : 0); }
  int body_b() const { return segment_b + (t_b >= 0.5 ? 1 : 0); }
};

struct ContactSet {
  /// Local minima of the gap up to the margin, sorted by arc_a, then arc_b: some 5 to 15 in a tight
  /// knot. The gap is positive everywhere if it is at those.
  std::vector<Contact> contacts;
  std::vector<Contact> on_obstacles;  ///< the same between the body and strands that are obstacles
  /// Pairs that nearly touch but are no minimum. They matter only where a step makes them one.
  std::vector<Contact> near_pairs;
  /// Least gap found, cm; at most the margin.
  double least_gap = 0;
};

/// Contact::normal between the points of `contact` where the segments are now.
Eigen::Vector3d contact_normal(const std::vector<SplineSegment>& segments, const Contact& contact);

/// Where the skins of `contact` meet: the middle between them on the line of its two points, where
/// the segments are now; cm, world.
Eigen::Vector3d skin_point(const std::vector<SplineSegment>& segments, const Contact& contact);

/// The pair of spline points (segment_a, t_a) and (segment_b, t_b), whatever the gap there.
Contact contact_at(const std::vector<SplineSegment>& segments, int segment_a, double t_a,
                   int segment_b, double t_b);

/// What a search knows of a pair so far. A pair is beaten where a neighbour has a smaller gap.
enum class PairState : char { unknown, queued, evaluated, beaten };

/// Storage of one search.
struct ContactScratch {
  std::vector<PairState> known;             ///< of each pair
  std::vector<int> queue;                   ///< pairs to evaluate next
  std::vector<int> close;                   ///< of those evaluated that are within the margin
  std::vector<ClosestPointsQuery> queries;  ///< of the queued pairs
  ClosestPointsSearch closest_points;
};

/// What a search for contacts keeps for the next one with the same settings. Pairs are skipped as
/// long as they cannot have moved close enough. A new minimum is found at once where strands touch
/// or come within the margin. Next to another minimum, and with a positive gap, it may be found
/// some steps late.
struct ContactSearch {
  Candidates candidates;
  ContactScratch scratch;
};

/// Finds the contacts of `segments` (paper, 3.1: bounding spheres, then Eq. 5) into `set`. Of pairs
/// that are no minimum, the first form lists those with a gap below `near` (cm), the second form
/// those that overlap.
void find_contacts(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                   double near, ContactSearch& search, ContactSet& set);
ContactSet find_contacts(const std::vector<SplineSegment>& segments,
                         const ContactSettings& settings);

}  // namespace hagfish
