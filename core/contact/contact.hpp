// Contact of the swept skin: where strands of the body touch or nearly touch each other or an
// obstacle that is a strand.
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
  int segment_a = 0, segment_b = 0;      ///< indices in the list of update_segments()
  double t_a = 0, t_b = 0;               ///< parameters on these segments, 0 to 1
  double arc_a = 0, arc_b = 0;           ///< arc length from the head, cm; infinite on an obstacle
  double gap = 0;                        ///< cm; negative where the skins overlap
  Eigen::Vector3d normal;                ///< unit, world, from b to a: gradient of the gap by x_a
  Eigen::Vector3d tangent_a, tangent_b;  ///< unit, world, both to the tail
  int obstacle = -1;                     ///< index of the obstacle that strand b is; -1: the body

  /// Body of the chain nearest to the point on strand a (b, where that is of the body).
  int body_a() const { return segment_a + (t_a >= 0.5 ? 1 : 0); }
  int body_b() const { return segment_b + (t_b >= 0.5 ? 1 : 0); }
  bool same_segments(const Contact& other) const {
    return segment_a == other.segment_a && segment_b == other.segment_b;
  }
};

struct ContactSet {
  /// Local minima of the gap up to the margin, sorted by arc_a, then arc_b: about 5 to 15 in a
  /// tight knot. If the gap is positive at all of them, it is positive everywhere.
  std::vector<Contact> contacts;
  std::vector<Contact> on_obstacles;  ///< minima between the body and strands that are obstacles
  /// Pairs that nearly touch but are not a minimum. They matter only if a step makes them one.
  std::vector<Contact> near_pairs;
  /// Least gap found, cm; at most the margin.
  double least_gap = 0;
};

/// Contact::normal between the points of `contact`, with the segments where they are now.
Eigen::Vector3d contact_normal(const std::vector<SplineSegment>& segments, const Contact& contact);

/// Point where the skins of `contact` meet: the middle between the skins on the line through its
/// two points, with the segments where they are now; cm, world.
Eigen::Vector3d skin_point(const std::vector<SplineSegment>& segments, const Contact& contact);

/// A Contact of the spline points (segment_a, t_a) and (segment_b, t_b), whatever their gap.
Contact contact_at(const std::vector<SplineSegment>& segments, int segment_a, double t_a,
                   int segment_b, double t_b);

/// What a search knows of a pair. A pair is `beaten` if a neighbour has a smaller gap.
enum class PairState : char { unknown, queued, evaluated, beaten };

/// Storage of one search.
struct ContactScratch {
  std::vector<PairState> known;             ///< state of each pair
  std::vector<int> queue;                   ///< pairs to evaluate next
  std::vector<int> close;                   ///< evaluated pairs within the margin
  std::vector<ClosestPointsQuery> queries;  ///< queries for the queued pairs
  ClosestPointsSearch closest_points;
};

/// State that a search for contacts keeps for the next one with the same settings. The search skips
/// pairs that cannot have moved close enough. It finds a new minimum at once where strands touch or
/// come within the margin. A second minimum next to a known one, with a positive gap, may be missed
/// for a few steps.
struct ContactSearch {
  Candidates candidates;
  ContactScratch scratch;
};

/// Writes the contacts of `segments` into `set` (paper, 3.1: bounding spheres, then Eq. 5).
/// near_pairs: pairs with gap < `near` (cm) that are not minima. The short form takes near = 0.
void find_contacts(const std::vector<SplineSegment>& segments, const ContactSettings& settings,
                   double near, ContactSearch& search, ContactSet& set);
ContactSet find_contacts(const std::vector<SplineSegment>& segments,
                         const ContactSettings& settings);

}  // namespace hagfish
