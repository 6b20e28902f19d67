#include "core/closest_points.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hagfish {
namespace {

// Samples a segment of the grid that starts are taken from: it must tell the basins of minima
// apart. Eight fill a vector register.
constexpr int samples = 8;
constexpr int iteration_limit = 50;
// Times that a step is halved for the gap to fall, to some 1e-4 of it.
constexpr int cut_limit = 14;
// Newton steps in a parameter of [0, 1] below this are at the rounding of the gap's minimum.
constexpr double step_tolerance = 1e-10;

double gap_at(const SplineSegment& a, const SplineSegment& b, double t_a, double t_b) {
  return (b.point(t_b) - a.point(t_a)).norm() - a.radius(t_a) - b.radius(t_b);
}

using Samples = Eigen::Array<double, samples, 1>;

/// Samples of the grid that no neighbour undercuts: one in each basin that the grid can tell apart.
struct Starts {
  std::array<ClosestPoints, samples * samples> at;
  int count = 0;
};

Starts starts_of(const SplineSegment& a, const SplineSegment& b) {
  const Samples t = Samples::LinSpaced(0, 1);
  std::array<Samples, 3> points_b;
  for (int k = 0; k < 3; ++k) {
    points_b[k] = b.c0[k] + t * (b.c1[k] + t * (b.c2[k] + t * b.c3[k]));
  }
  const Samples radius_b = b.r0 + t * b.r1;
  // With a rim that undercuts nothing.
  Eigen::Array<double, samples + 2, samples + 2> gap;
  gap.setConstant(std::numeric_limits<double>::infinity());
  for (int i = 0; i < samples; ++i) {
    const Eigen::Vector3d point_a = a.point(t[i]);
    gap.col(i + 1).segment<samples>(1) =
        ((points_b[0] - point_a[0]).square() + (points_b[1] - point_a[1]).square() +
         (points_b[2] - point_a[2]).square())
            .sqrt() -
        (radius_b + a.radius(t[i]));
  }
  Eigen::Array<double, samples, samples + 2> lowest;  // of three along b, then of nine
  lowest = gap.topRows<samples>().min(gap.middleRows<samples>(1)).min(gap.bottomRows<samples>());
  Starts starts;
  for (int i = 0; i < samples; ++i) {
    const Samples least = lowest.col(i).min(lowest.col(i + 1)).min(lowest.col(i + 2));
    for (int j = 0; j < samples; ++j) {
      if (gap(j + 1, i + 1) <= least[j]) {
        starts.at[starts.count++] = {t[i], t[j], gap(j + 1, i + 1)};
      }
    }
  }
  return starts;
}

/// A Newton direction on the free parameters; `g` is the gradient, `h` the Hessian, `safe` its
/// positive part.
Eigen::Vector2d direction(const Eigen::Vector2d& g, const Eigen::Matrix2d& h,
                          const Eigen::Matrix2d& safe, bool free_a, bool free_b) {
  if (free_a && free_b) {
    const double determinant = h.determinant();
    if (h(0, 0) > 0 && determinant > 1e-12 * safe(0, 0) * safe(1, 1)) {
      return -Eigen::Vector2d(h(1, 1) * g[0] - h(0, 1) * g[1], h(0, 0) * g[1] - h(1, 0) * g[0]) /
             determinant;
    }
    return {-g[0] / (2 * safe(0, 0)), -g[1] / (2 * safe(1, 1))};
  }
  const int k = free_a ? 0 : 1;
  Eigen::Vector2d step = Eigen::Vector2d::Zero();
  step[k] = -g[k] / (h(k, k) > 1e-12 * safe(k, k) ? h(k, k) : safe(k, k));
  return step;
}

/// Safeguarded Newton from `at`.
ClosestPoints descend(const SplineSegment& a, const SplineSegment& b, ClosestPoints at) {
  for (int iteration = 0; iteration < iteration_limit; ++iteration) {
    const Eigen::Vector3d d = b.point(at.t_b) - a.point(at.t_a);
    const double distance = d.norm();
    if (!(distance > 0)) {
      break;  // the centrelines cross: the gap is as low as it gets
    }
    const Eigen::Vector3d n = d / distance;
    const Eigen::Vector3d xa = a.slope(at.t_a);
    const Eigen::Vector3d xb = b.slope(at.t_b);
    // Eq. 5 over the distance, with the taper of the body.
    const Eigen::Vector2d g(-xa.dot(n) - a.r1, xb.dot(n) - b.r1);
    const bool free_a = !(at.t_a <= 0 && g[0] >= 0) && !(at.t_a >= 1 && g[0] <= 0);
    const bool free_b = !(at.t_b <= 0 && g[1] >= 0) && !(at.t_b >= 1 && g[1] <= 0);
    if (!free_a && !free_b) {
      break;
    }
    const double an = xa.dot(n);
    const double bn = xb.dot(n);
    Eigen::Matrix2d h;
    h(0, 0) = -a.bend(at.t_a).dot(n) + (xa.squaredNorm() - an * an) / distance;
    h(1, 1) = b.bend(at.t_b).dot(n) + (xb.squaredNorm() - bn * bn) / distance;
    h(0, 1) = h(1, 0) = -(xa.dot(xb) - an * bn) / distance;
    const Eigen::Matrix2d safe =
        Eigen::Vector2d(xa.squaredNorm() / distance, xb.squaredNorm() / distance).asDiagonal();
    const Eigen::Vector2d step = direction(g, h, safe, free_a, free_b);

    bool moved = false;
    double length = 1;
    for (int cut = 0; cut < cut_limit; ++cut, length *= 0.5) {
      const double t_a = std::clamp(at.t_a + length * step[0], 0.0, 1.0);
      const double t_b = std::clamp(at.t_b + length * step[1], 0.0, 1.0);
      const double gap = gap_at(a, b, t_a, t_b);
      if (gap < at.gap) {
        moved = std::abs(t_a - at.t_a) + std::abs(t_b - at.t_b) > step_tolerance;
        at = {t_a, t_b, gap};
        break;
      }
    }
    if (!moved) {
      break;
    }
  }
  return at;
}

}  // namespace

ClosestPoints closest_points(const SplineSegment& a, const SplineSegment& b) {
  const Starts starts = starts_of(a, b);
  ClosestPoints best = descend(a, b, starts.at[0]);
  for (int k = 1; k < starts.count; ++k) {
    const ClosestPoints other = descend(a, b, starts.at[k]);
    if (other.gap < best.gap) {
      best = other;
    }
  }
  return best;
}

}  // namespace hagfish
