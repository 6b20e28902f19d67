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

/// Two segments whose closest points are wanted, with a `guess` such as the answer a step ago.
struct ClosestPointsQuery {
  const SplineSegment* a = nullptr;
  const SplineSegment* b = nullptr;
  std::optional<ClosestPoints> guess;
  ClosestPoints closest = {};  ///< the answer
};

/// Minimises the gap between the skins, φ(t_a, t_b) = |x_b - x_a| - r(t_a) - r(t_b), over both
/// parameters. With a constant radius its gradient is Eq. 5 over the distance; the taper adds
/// -r'. The gap, not the distance, is what must stay positive, and at its minimum the derivative
/// by q is that of the centreline points alone (envelope theorem), also for parallel strands.
///
/// Newton where the Hessian is positive on the free parameters, else the part of it that always is
/// (Gauss-Newton); steps are cut until the gap falls, parameters stay in [0, 1]. Plain clamped
/// Newton cycles on 7 % of candidate pairs.
/// Starts from samples of both segments, one in each basin that they resolve; where there is only
/// one, the guess replaces it if its gap is smaller, or is a second start where it is further off
/// than the next sample.
///
/// Queries are answered side by side, as many as a vector register has lanes, each as if it were
/// alone.
class ClosestPointsSearch {
 public:
  /// `samples`: along each segment, 3 to most_samples.
  void answer(int samples, std::span<ClosestPointsQuery> queries);

 private:
  /// Points to go down from: those of a basin of the samples, or of the guess if they are closer.
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
/// That resolve the basins of the gap along a segment so many times as long as its radius.
int samples_along(double slenderness);

/// Of one pair, with most_samples.
ClosestPoints closest_points(const SplineSegment& a, const SplineSegment& b,
                             const std::optional<ClosestPoints>& guess = std::nullopt);

}  // namespace hagfish
