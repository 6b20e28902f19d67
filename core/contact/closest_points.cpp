#include "core/contact/closest_points.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "core/chain/lanes.hpp"

namespace hagfish {
namespace {

constexpr int iteration_limit = 50;
// How often a step is halved until the gap falls, down to about 1e-4 of it.
constexpr int cut_limit = 14;
// After a full Newton step below this, in parameters of [0, 1], the error is about its square. The
// error of the gap is the square of that, which is rounding.
constexpr double whole_step_tolerance = 1e-4;
// After a shortened step the error is about the size of the step.
constexpr double cut_step_tolerance = 1e-7;
// A Hessian below this share of its positive part counts as singular.
constexpr double least_share = 1e-12;
// Largest distance of samples on a segment, as a share of its radius, and at least 3 samples. They
// must resolve the basins of the minima, which are as wide as the body's bends.
constexpr double sample_spacing = 0.09;

// Single precision is sufficient to choose starts, and takes half the time.
using SampleLanes = FloatLanes;
constexpr int sample_lanes = float_lane_count;

/// Sampled points and radii of a segment in each lane.
struct SampledSegments {
  std::array<std::array<SampleLanes, 3>, most_samples> point;
  std::array<SampleLanes, most_samples> radius;
};

/// Samples one segment of each query, seen from the first end of its segment a: nearby numbers keep
/// their digits in single precision.
void sample_segments(std::span<const ClosestPointsQuery> queries,
                     const SplineSegment* ClosestPointsQuery::*segment, int samples,
                     SampledSegments& sampled) {
  std::array<std::array<FloatLaneValues, 3>, 4> c{};
  FloatLaneValues r0{}, r1{};
  for (std::size_t k = 0; k < queries.size(); ++k) {
    const SplineSegment& s = *(queries[k].*segment);
    const Eigen::Vector3d& origin = queries[k].a->c0;
    for (int i = 0; i < 3; ++i) {
      c[0][i][k] = static_cast<float>(s.c0[i] - origin[i]);
      c[1][i][k] = static_cast<float>(s.c1[i]);
      c[2][i][k] = static_cast<float>(s.c2[i]);
      c[3][i][k] = static_cast<float>(s.c3[i]);
    }
    r0[k] = static_cast<float>(s.r0);
    r1[k] = static_cast<float>(s.r1);
  }
  for (int j = 0; j < samples; ++j) {
    const float t = static_cast<float>(j) / static_cast<float>(samples - 1);
    for (int i = 0; i < 3; ++i) {
      sampled.point[j][i] =
          lanes_of(c[0][i]) +
          t * (lanes_of(c[1][i]) + t * (lanes_of(c[2][i]) + t * lanes_of(c[3][i])));
    }
    sampled.radius[j] = lanes_of(r0) + t * lanes_of(r1);
  }
}

/// Local minima of the gap on the grid, one in each basin that the grid resolves: bit 8 i + j for
/// sample i of a and j of b.
std::array<std::uint64_t, sample_lanes> basins(const SampledSegments& a, const SampledSegments& b,
                                               int samples) {
  // With a border of infinite gap.
  constexpr int side = most_samples + 2;
  std::array<std::array<SampleLanes, side>, side> gap, lowest;  // of three along b
  const SampleLanes infinite = SampleLanes{} + std::numeric_limits<float>::infinity();
  for (int j = 0; j < samples + 2; ++j) {
    gap[0][j] = gap[samples + 1][j] = infinite;
    lowest[0][j] = lowest[samples + 1][j] = infinite;
  }
  for (int i = 0; i < samples; ++i) {
    auto& row = gap[i + 1];
    row[0] = row[samples + 1] = infinite;
    for (int j = 0; j < samples; ++j) {
      const SampleLanes x = b.point[j][0] - a.point[i][0];
      const SampleLanes y = b.point[j][1] - a.point[i][1];
      const SampleLanes z = b.point[j][2] - a.point[i][2];
      row[j + 1] = root(x * x + y * y + z * z) - (b.radius[j] + a.radius[i]);
    }
    for (int j = 1; j <= samples; ++j) {
      lowest[i + 1][j] = least(least(row[j - 1], row[j]), row[j + 1]);
    }
  }
  std::array<FloatLaneMask, 2> found{};  // upper and lower half of the samples of a
  for (int i = 0; i < samples; ++i) {
    for (int j = 0; j < samples; ++j) {
      const SampleLanes around =
          least(least(lowest[i][j + 1], lowest[i + 1][j + 1]), lowest[i + 2][j + 1]);
      const auto bit = static_cast<std::int32_t>(1U << (8 * (i % 4) + j));
      found[i / 4] |= (gap[i + 1][j + 1] <= around) & (FloatLaneMask{} + bit);
    }
  }
  std::array<std::uint64_t, sample_lanes> bits{};
  for (int k = 0; k < sample_lanes; ++k) {
    bits[k] = static_cast<std::uint32_t>(found[0][k]) |
              static_cast<std::uint64_t>(static_cast<std::uint32_t>(found[1][k])) << 32;
  }
  return bits;
}

/// A segment in each lane.
struct LaneSegments {
  LaneVector c0, c1, c2, c3;
  Lanes r0, r1;

  /// `of(k)` is that of lane k.
  template <class Of>
  explicit LaneSegments(Of of) {
    std::array<std::array<LaneValues, 3>, 4> c;
    LaneValues first, slope;
    for (int k = 0; k < lane_count; ++k) {
      const SplineSegment& s = of(k);
      for (int i = 0; i < 3; ++i) {
        c[0][i][k] = s.c0[i];
        c[1][i][k] = s.c1[i];
        c[2][i][k] = s.c2[i];
        c[3][i][k] = s.c3[i];
      }
      first[k] = s.r0;
      slope[k] = s.r1;
    }
    const auto vector = [](const std::array<LaneValues, 3>& v) {
      return LaneVector{lanes_of(v[0]), lanes_of(v[1]), lanes_of(v[2])};
    };
    c0 = vector(c[0]);
    c1 = vector(c[1]);
    c2 = vector(c[2]);
    c3 = vector(c[3]);
    r0 = lanes_of(first);
    r1 = lanes_of(slope);
  }
  LaneVector point(const Lanes& t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
  LaneVector slope(const Lanes& t) const { return c1 + t * (2 * c2 + (3 * t) * c3); }
  LaneVector bend(const Lanes& t) const { return 2 * c2 + (6 * t) * c3; }
  Lanes radius(const Lanes& t) const { return r0 + t * r1; }
};

/// The present iterates of several descents.
struct Iterate {
  Lanes t_a, t_b;
  LaneVector apart;  ///< x_b - x_a
  Lanes distance;    ///< |apart|
  Lanes gap;
};

Iterate iterate_at(const LaneSegments& a, const LaneSegments& b, const Lanes& t_a,
                   const Lanes& t_b) {
  const LaneVector apart = b.point(t_b) - a.point(t_a);
  const Lanes distance = root(dot(apart, apart));
  return {t_a, t_b, apart, distance, distance - a.radius(t_a) - b.radius(t_b)};
}

/// In the lanes of `which`, the iterate becomes `next`.
void move(const LaneMask& which, const Iterate& next, Iterate& at) {
  at.t_a = which ? next.t_a : at.t_a;
  at.t_b = which ? next.t_b : at.t_b;
  at.apart = {which ? next.apart.x : at.apart.x, which ? next.apart.y : at.apart.y,
              which ? next.apart.z : at.apart.z};
  at.distance = which ? next.distance : at.distance;
  at.gap = which ? next.gap : at.gap;
}

/// How the gap changes with both parameters at an iterate.
struct Slopes {
  Lanes ga, gb;  ///< gradient: Eq. 5 over the distance, with the taper of the body
  /// Inverse of the part of each diagonal entry of the Hessian that is always positive, |x'|² over
  /// the distance; and the root of both.
  Lanes width_a, width_b, width;
  /// Hessian over that part. So it has no unit, and least_share suits segments of any length.
  Lanes haa, hbb, hab;
};

Slopes slopes_at(const LaneSegments& a, const LaneSegments& b, const Iterate& at) {
  const Lanes one = lanes_of(1);
  const Lanes inverse = one / at.distance;
  const LaneVector n = inverse * at.apart;
  const LaneVector xa = a.slope(at.t_a);
  const LaneVector xb = b.slope(at.t_b);
  const Lanes an = dot(xa, n);
  const Lanes bn = dot(xb, n);
  Slopes s;
  s.ga = -an - a.r1;
  s.gb = bn - b.r1;
  s.width_a = one / (dot(xa, xa) * inverse);
  s.width_b = one / (dot(xb, xb) * inverse);
  s.width = root(s.width_a * s.width_b);
  s.haa = one - (an * an * inverse + dot(a.bend(at.t_a), n)) * s.width_a;
  s.hbb = one - (bn * bn * inverse - dot(b.bend(at.t_b), n)) * s.width_b;
  s.hab = -(dot(xa, xb) - an * bn) * inverse * s.width;
  return s;
}

/// A positive symmetric matrix.
struct Positive {
  Lanes aa, bb, ab;
};

/// The Hessian, or what stands for it where it is not positive.
Positive made_positive(const Slopes& s) {
  const Lanes zero{};
  const Lanes one = lanes_of(1);
  // Where the Hessian is indefinite, the gap falls from a crest towards both ends of a valley,
  // faster further away from the crest. |H|, with its eigenvalues m ± r made positive, doubles the
  // distance at each step: it is (m H + (r² - m²) 1) / r.
  const Lanes determinant = s.haa * s.hbb - s.hab * s.hab;
  const Lanes mean = 0.5 * (s.haa + s.hbb);
  const Lanes inverse_radius = one / root(mean * mean - determinant);
  const LaneMask crest = determinant < lanes_of(-least_share);
  const Lanes turn = crest ? mean * inverse_radius : one;
  const Lanes lift = crest ? -determinant * inverse_radius : zero;
  const LaneMask regular = crest | ((s.haa > zero) & (determinant > lanes_of(least_share)));
  // Elsewhere 2 stands for the positive part, whose eigenvalues are 1 ± |cos| of the slopes' angle:
  // a step that far along the gradient does not overshoot it.
  return {regular ? turn * s.haa + lift : 2 * one, regular ? turn * s.hbb + lift : 2 * one,
          regular ? turn * s.hab : zero};
}

struct Direction {
  Lanes a, b;       ///< step of each parameter, 0 if it is not free
  LaneMask moving;  ///< whether at least one is free
};

/// The Newton direction on the free parameters, downhill. A parameter on its bound is free if the
/// gap falls inwards.
Direction direction(const LaneSegments& a, const LaneSegments& b, const Iterate& at) {
  const Lanes zero{};
  const Lanes one = lanes_of(1);
  const Slopes s = slopes_at(a, b, at);
  const LaneMask free_a =
      ~(((at.t_a <= zero) & (s.ga >= zero)) | ((at.t_a >= one) & (s.ga <= zero)));
  const LaneMask free_b =
      ~(((at.t_b <= zero) & (s.gb >= zero)) | ((at.t_b >= one) & (s.gb <= zero)));
  const LaneMask both = free_a & free_b;
  // The step is -M⁻¹ g of both parameters, or -g / |h| of one alone: downhill also on a crest.
  const Positive m = made_positive(s);
  const Lanes alone = magnitude(free_a ? s.haa : s.hbb);
  const Lanes divisor = both ? m.aa * m.bb - m.ab * m.ab : alone;
  const Lanes share = divisor > lanes_of(least_share) ? one / divisor : one;
  const Lanes step_a =
      share * (both ? m.ab * s.width * s.gb - m.bb * s.width_a * s.ga : -s.width_a * s.ga);
  const Lanes step_b =
      share * (both ? m.ab * s.width * s.ga - m.aa * s.width_b * s.gb : -s.width_b * s.gb);
  return {free_a ? step_a : zero, free_b ? step_b : zero, free_a | free_b};
}

/// Safeguarded Newton from `at`.
void descend_lanes(const LaneSegments& a, const LaneSegments& b, Iterate& at) {
  const Lanes zero{};
  const Lanes one = lanes_of(1);
  LaneMask active = at.distance >= zero;
  for (int iteration = 0; iteration < iteration_limit; ++iteration) {
    active &= at.distance > zero;  // else the centrelines cross, and the gap is minimal
    const Direction step = direction(a, b, at);
    active &= step.moving;
    LaneMask searching = active;
    LaneMask last = active;
    double length = 1;
    for (int cut = 0; cut < cut_limit && any(searching); ++cut) {
      const Lanes t_a = least(largest(at.t_a + length * step.a, zero), one);
      const Lanes t_b = least(largest(at.t_b + length * step.b, zero), one);
      const double tolerance = cut == 0 ? whole_step_tolerance : cut_step_tolerance;
      const LaneMask small =
          magnitude(t_a - at.t_a) + magnitude(t_b - at.t_b) <= lanes_of(tolerance);
      const Iterate next = iterate_at(a, b, t_a, t_b);
      const LaneMask lower = searching & (next.gap < at.gap);
      move(lower, next, at);
      last &= ~lower | small;
      searching &= ~(lower | small);
      length *= 0.5;
    }
    active &= ~last;
    if (!any(active)) return;
  }
}

}  // namespace

int samples_along(double slenderness) {
  return std::clamp(static_cast<int>(std::ceil(slenderness / sample_spacing)) + 1, 3, most_samples);
}

void ClosestPointsSearch::answer(int samples, std::span<ClosestPointsQuery> queries) {
  descents_.clear();
  for (std::size_t first = 0; first < queries.size(); first += sample_lanes) {
    sample(samples, queries, first);
  }
  for (ClosestPointsQuery& query : queries) {
    query.closest = {0, 0, INFINITY};
  }
  for (std::size_t first = 0; first < descents_.size(); first += lane_count) {
    descend(queries, first);
  }
}

/// Lists the starts of the batch of queries that begins with query `first`.
void ClosestPointsSearch::sample(int samples, std::span<const ClosestPointsQuery> queries,
                                 std::size_t first) {
  const auto batch =
      queries.subspan(first, std::min<std::size_t>(sample_lanes, queries.size() - first));
  SampledSegments a, b;
  sample_segments(batch, &ClosestPointsQuery::a, samples, a);
  sample_segments(batch, &ClosestPointsQuery::b, samples, b);
  const auto found = basins(a, b, samples);
  const double spacing = 1.0 / (samples - 1);
  for (std::size_t k = 0; k < batch.size(); ++k) {
    const bool single = std::has_single_bit(found[k]);
    for (std::uint64_t bits = found[k]; bits != 0; bits &= bits - 1) {
      const int bit = std::countr_zero(bits);
      const int i = bit / most_samples;
      const int j = bit % most_samples;
      const double t_a = spacing * i;
      const double t_b = spacing * j;
      const ClosestPoints guess =
          single && batch[k].guess ? *batch[k].guess : ClosestPoints{t_a, t_b};
      const bool near = std::max(std::abs(guess.t_a - t_a), std::abs(guess.t_b - t_b)) <= spacing;
      descents_.push_back({first + k, t_a, t_b, near ? guess.t_a : t_a, near ? guess.t_b : t_b});
      if (!near) {  // it may be in a basin that the samples do not resolve
        descents_.push_back({first + k, guess.t_a, guess.t_b, guess.t_a, guess.t_b});
      }
    }
  }
}

/// Descends from a batch of starts, each from the lower one of the sample and the guess.
void ClosestPointsSearch::descend(std::span<ClosestPointsQuery> queries, std::size_t first) const {
  const int count = static_cast<int>(std::min<std::size_t>(lane_count, descents_.size() - first));
  const auto descent = [&](int k) -> const Descent& {
    return descents_[first + std::min(k, count - 1)];  // spare lanes repeat the last start
  };
  const LaneSegments a([&](int k) -> const auto& { return *queries[descent(k).query].a; });
  const LaneSegments b([&](int k) -> const auto& { return *queries[descent(k).query].b; });
  LaneValues t_a, t_b, guess_a, guess_b;
  for (int k = 0; k < lane_count; ++k) {
    t_a[k] = descent(k).t_a;
    t_b[k] = descent(k).t_b;
    guess_a[k] = descent(k).guess_a;
    guess_b[k] = descent(k).guess_b;
  }
  Iterate at = iterate_at(a, b, lanes_of(t_a), lanes_of(t_b));
  const Iterate guessed = iterate_at(a, b, lanes_of(guess_a), lanes_of(guess_b));
  move(guessed.gap < at.gap, guessed, at);
  descend_lanes(a, b, at);
  for (int k = 0; k < count; ++k) {
    ClosestPoints& closest = queries[descents_[first + k].query].closest;
    if (at.gap[k] < closest.gap) closest = {at.t_a[k], at.t_b[k], at.gap[k]};
  }
}

ClosestPoints closest_points(const SplineSegment& a, const SplineSegment& b,
                             const std::optional<ClosestPoints>& guess) {
  ClosestPointsQuery query{&a, &b, guess};
  ClosestPointsSearch().answer(most_samples, {&query, 1});
  return query.closest;
}

}  // namespace hagfish
