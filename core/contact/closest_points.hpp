// Closest points of two spline segments: a safeguarded Newton method on the paper's Eq. 5.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/contact/spline.hpp"

namespace hagfish {

struct ClosestPoints {
  double t_a = 0, t_b = 0;  ///< parameters in [0, 1]
  double gap = 0;           ///< |x_a - x_b| - r_a - r_b, cm
};

/// Two segments whose closest points are wanted, and a `guess` such as the answer of the last step.
struct ClosestPointsQuery {
  const SplineSegment* a = nullptr;
  const SplineSegment* b = nullptr;
  std::optional<ClosestPoints> guess;
  ClosestPoints closest = {};  ///< the answer
};

/// Minimises the gap between the skins, φ(t_a, t_b) = |x_b - x_a| - r(t_a) - r(t_b), over both
/// parameters. With a constant radius its gradient is Eq. 5 over the distance; the taper adds -r'.
/// The gap must stay positive, so the gap and not the distance is minimised. At its minimum the
/// derivative by q is that of the centreline points alone (envelope theorem), also for parallel
/// strands.
///
/// The method is Newton's where the Hessian is positive on the free parameters. Else it uses the
/// part of the Hessian that is always positive (Gauss-Newton). Steps are shortened until the gap
/// falls, and parameters stay in [0, 1]. Plain Newton with clamped parameters cycles on 7 % of
/// candidate pairs.
///
/// Descents start from samples of both segments, one in each basin that the samples resolve. Where
/// there is only one basin, the guess replaces its sample if the gap of the guess is smaller. If
/// the guess is further off than the next sample, it is a second start instead.
///
/// As many queries as a vector register has lanes are answered at the same time. No answer depends
/// on the other queries.
class ClosestPointsSearch {
 public:
  /// Writes the answers into `queries`. `samples` along each segment: 3 to most_samples.
  void answer(int samples, std::span<ClosestPointsQuery> queries);

 private:
  /// Start of a descent: a sample of a basin, or the guess if its gap is smaller.
  struct Descent {
    std::size_t query = 0;
    double t_a = 0, t_b = 0;
    double guess_a = 0, guess_b = 0;
  };
  void sample(int samples, std::span<const ClosestPointsQuery> queries, std::size_t first);
  void descend(std::span<ClosestPointsQuery> queries, std::size_t first) const;

  std::vector<Descent> descents_;  ///< storage
};

inline constexpr int most_samples = 8;
/// Samples that resolve the basins of the gap along a segment whose length is `slenderness` radii.
int samples_along(double slenderness);

/// The closest points of one pair, with most_samples.
ClosestPoints closest_points(const SplineSegment& a, const SplineSegment& b,
                             const std::optional<ClosestPoints>& guess = std::nullopt);

}  // namespace hagfish
