#include "tests/support/closest_points_reference.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace hagfish {
namespace {

// Samples per segment of the grid that starts are taken from: it must resolve the basins of the
// minima. Eight fill a vector register.
constexpr int samples = 8;
constexpr int iteration_limit = 50;
// Times that a step is halved for the gap to fall, to some 1e-4 of it.
constexpr int cut_limit = 14;
// A whole Newton step in parameters of [0, 1] below this leaves an error of about its square, and
// in the gap of the square of that, which is rounding.
constexpr double whole_step_tolerance = 1e-4;
// A step that was cut leaves an error of about its own size.
constexpr double cut_step_tolerance = 1e-7;

/// A pair of points on its way down.
struct Iterate {
  double t_a, t_b;
  Eigen::Vector3d apart;  ///< x_b - x_a
  double distance;        ///< |apart|
  double gap;
};

Iterate iterate_at(const SplineSegment& a, const SplineSegment& b, double t_a, double t_b) {
  const Eigen::Vector3d apart = b.point(t_b) - a.point(t_a);
  const double distance = apart.norm();
  return {t_a, t_b, apart, distance, distance - a.radius(t_a) - b.radius(t_b)};
}

// Single precision is enough to choose starts, in half the time.
using Samples = Eigen::Array<float, samples, 1>;

/// Local minima of the gap on the grid: one in each basin that the grid resolves.
struct Starts {
  std::array<std::pair<double, double>, samples * samples> at;  ///< t_a, t_b
  int count = 0;
};

/// The sampled points of a segment, by coordinate, from `origin`.
std::array<Samples, 3> sampled_points(const SplineSegment& s, const Samples& t,
                                      const Eigen::Vector3d& origin) {
  const Eigen::Vector3f c0 = (s.c0 - origin).cast<float>();
  const Eigen::Vector3f c1 = s.c1.cast<float>();
  const Eigen::Vector3f c2 = s.c2.cast<float>();
  const Eigen::Vector3f c3 = s.c3.cast<float>();
  std::array<Samples, 3> points;
  for (int k = 0; k < 3; ++k) {
    points[k] = c0[k] + t * (c1[k] + t * (c2[k] + t * c3[k]));
  }
  return points;
}

Samples sampled_radii(const SplineSegment& s, const Samples& t) {
  return static_cast<float>(s.r0) + t * static_cast<float>(s.r1);
}

Starts starts_of(const SplineSegment& a, const SplineSegment& b) {
  static const Samples t = Samples::LinSpaced(0, 1);
  const std::array<Samples, 3> points_a = sampled_points(a, t, a.c0);
  const std::array<Samples, 3> points_b = sampled_points(b, t, a.c0);
  const Samples radii_a = sampled_radii(a, t);
  const Samples radii_b = sampled_radii(b, t);
  // With a border of infinite gap.
  Eigen::Array<float, samples + 2, samples + 2> gap;
  gap.setConstant(std::numeric_limits<float>::infinity());
  for (int i = 0; i < samples; ++i) {
    gap.col(i + 1).segment<samples>(1) =
        ((points_b[0] - points_a[0][i]).square() + (points_b[1] - points_a[1][i]).square() +
         (points_b[2] - points_a[2][i]).square())
            .sqrt() -
        (radii_b + radii_a[i]);
  }
  Eigen::Array<float, samples, samples + 2> lowest;  // of three along b, then of nine
  lowest = gap.topRows<samples>().min(gap.middleRows<samples>(1)).min(gap.bottomRows<samples>());
  Starts starts;
  for (int i = 0; i < samples; ++i) {
    const Samples least = lowest.col(i).min(lowest.col(i + 1)).min(lowest.col(i + 2));
    const Samples own = gap.col(i + 1).segment<samples>(1);
    if ((own - least).minCoeff() > 0) {
      continue;
    }
    for (int j = 0; j < samples; ++j) {
      if (own[j] <= least[j]) {
        starts.at[starts.count++] = {t[i], t[j]};
      }
    }
  }
  return starts;
}

/// A Newton direction on the free parameters; `g` is the gradient, `h` the Hessian, `safe` its
/// positive part. Where the Hessian is indefinite, its eigenvalues are made positive.
Eigen::Vector2d direction(const Eigen::Vector2d& g, const Eigen::Matrix2d& h,
                          const Eigen::Vector2d& safe, bool free_a, bool free_b) {
  constexpr double least_share = 1e-12;
  if (free_a && free_b) {
    const Eigen::Vector2d root = safe.cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(root.asDiagonal() * h *
                                                               root.asDiagonal());
    const Eigen::Vector2d values = eigen.eigenvalues();
    const double determinant = values.prod();
    if (determinant < -least_share || (determinant > least_share && values[0] > 0)) {
      return -root.cwiseProduct(eigen.eigenvectors() *
                                (eigen.eigenvectors().transpose() * root.cwiseProduct(g))
                                    .cwiseQuotient(values.cwiseAbs()));
    }
    return -g.cwiseQuotient(2 * safe);
  }
  const int k = free_a ? 0 : 1;
  Eigen::Vector2d step = Eigen::Vector2d::Zero();
  step[k] = -g[k] / (std::abs(h(k, k)) > least_share * safe[k] ? std::abs(h(k, k)) : safe[k]);
  return step;
}

/// Safeguarded Newton from `start`.
Iterate descend(const SplineSegment& a, const SplineSegment& b, Iterate at) {
  for (int iteration = 0; iteration < iteration_limit; ++iteration) {
    if (!(at.distance > 0)) {
      break;  // the centrelines cross: the gap is as low as it gets
    }
    const Eigen::Vector3d n = at.apart / at.distance;
    const Eigen::Vector3d xa = a.slope(at.t_a);
    const Eigen::Vector3d xb = b.slope(at.t_b);
    const double an = xa.dot(n);
    const double bn = xb.dot(n);
    // Eq. 5 over the distance, with the taper of the body.
    const Eigen::Vector2d g(-an - a.r1, bn - b.r1);
    const bool free_a = !(at.t_a <= 0 && g[0] >= 0) && !(at.t_a >= 1 && g[0] <= 0);
    const bool free_b = !(at.t_b <= 0 && g[1] >= 0) && !(at.t_b >= 1 && g[1] <= 0);
    if (!free_a && !free_b) {
      break;
    }
    const double inverse = 1 / at.distance;
    Eigen::Matrix2d h;
    h(0, 0) = -a.bend(at.t_a).dot(n) + (xa.squaredNorm() - an * an) * inverse;
    h(1, 1) = b.bend(at.t_b).dot(n) + (xb.squaredNorm() - bn * bn) * inverse;
    h(0, 1) = h(1, 0) = -(xa.dot(xb) - an * bn) * inverse;
    const Eigen::Vector2d safe(xa.squaredNorm() * inverse, xb.squaredNorm() * inverse);
    const Eigen::Vector2d step = direction(g, h, safe, free_a, free_b);

    bool last = true;
    double length = 1;
    for (int cut = 0; cut < cut_limit; ++cut, length *= 0.5) {
      const double t_a = std::clamp(at.t_a + length * step[0], 0.0, 1.0);
      const double t_b = std::clamp(at.t_b + length * step[1], 0.0, 1.0);
      const bool small = std::abs(t_a - at.t_a) + std::abs(t_b - at.t_b) <=
                         (cut == 0 ? whole_step_tolerance : cut_step_tolerance);
      const Iterate next = iterate_at(a, b, t_a, t_b);
      if (next.gap < at.gap) {
        last = small;
        at = next;
        break;
      }
      if (small) {
        break;
      }
    }
    if (last) {
      break;
    }
  }
  return at;
}

}  // namespace

ClosestPoints closest_points_reference(const SplineSegment& a, const SplineSegment& b,
                                       const std::optional<ClosestPoints>& guess) {
  const Starts starts = starts_of(a, b);
  const auto start = [&](int k) {
    return iterate_at(a, b, starts.at[k].first, starts.at[k].second);
  };
  const Iterate first = start(0);
  Iterate best = descend(a, b, first);
  if (guess && starts.count == 1) {
    const Iterate guessed = iterate_at(a, b, guess->t_a, guess->t_b);
    const bool apart =
        std::max(std::abs(first.t_a - guess->t_a), std::abs(first.t_b - guess->t_b)) *
            (samples - 1) >
        1;
    if (apart) {
      const Iterate other = descend(a, b, guessed);
      best = other.gap < best.gap ? other : best;
    } else if (guessed.gap < first.gap) {
      best = descend(a, b, guessed);
    }
  }
  for (int k = 1; k < starts.count; ++k) {
    const Iterate other = descend(a, b, start(k));
    if (other.gap < best.gap) {
      best = other;
    }
  }
  return {best.t_a, best.t_b, best.gap};
}

}  // namespace hagfish
