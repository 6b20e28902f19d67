#include "core/contact/spline.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {

SplineMix spline_mix(int segment, double t, int bodies) {
  const double t2 = t * t;
  const double t3 = t2 * t;
  const std::array<double, 4> w = {0.5 * (-t + 2 * t2 - t3), 0.5 * (2 - 5 * t2 + 3 * t3),
                                   0.5 * (t + 4 * t2 - 3 * t3), 0.5 * (t3 - t2)};
  const bool at_head = segment == 0;
  const bool at_tail = segment == bodies - 2;
  SplineMix mix;
  mix.parameter = segment + t;
  mix.first = at_head ? 0 : segment - 1;
  const int skipped = at_head ? 1 : 0;
  mix.count = 4 - skipped - (at_tail ? 1 : 0);
  for (int k = 0; k < mix.count; ++k) mix.weight[k] = w[k + skipped];
  if (at_head) {  // the phantom before the head is 2 p0 - p1
    mix.weight[0] += 2 * w[0];
    mix.weight[1] -= w[0];
  }
  if (at_tail) {
    mix.weight[mix.count - 1] += 2 * w[3];
    mix.weight[mix.count - 2] -= w[3];
  }
  return mix;
}

void set_curve(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, const Eigen::Vector3d& p2,
               const Eigen::Vector3d& p3, SplineSegment& s) {
  s.c0 = p1;
  s.c1 = 0.5 * (p2 - p0);
  s.c2 = 0.5 * (2 * p0 - 5 * p1 + 4 * p2 - p3);
  s.c3 = 0.5 * (-p0 + 3 * p1 - 3 * p2 + p3);
  // A cubic lies in the hull of its Bézier points, two of which are the ends.
  s.middle = 0.5 * (p1 + p2);
  constexpr double sixth = 1.0 / 6;
  const Eigen::Vector3d b1 = p1 + sixth * (p2 - p0);
  const Eigen::Vector3d b2 = p2 - sixth * (p3 - p1);
  s.bound = std::sqrt(std::max({(p1 - s.middle).squaredNorm(), (b1 - s.middle).squaredNorm(),
                                (b2 - s.middle).squaredNorm()})) +
            std::max(s.r0, s.r0 + s.r1);
}

void update_spline(const Model& model, const Eigen::Matrix3Xd& centre,
                   std::vector<SplineSegment>& segments) {
  const int n = model.body_count();
  segments.resize(n - 1);
  double arc = 0.5 * model.bodies[0].length;
  for (int i = 0; i + 1 < n; ++i) {
    const Eigen::Vector3d p1 = centre.col(i);
    const Eigen::Vector3d p2 = centre.col(i + 1);
    const Eigen::Vector3d p0 = i > 0 ? centre.col(i - 1).eval() : (2 * p1 - p2).eval();
    const Eigen::Vector3d p3 = i + 2 < n ? centre.col(i + 2).eval() : (2 * p2 - p1).eval();
    SplineSegment& s = segments[i];
    s.r0 = model.bodies[i].radius;
    s.r1 = model.bodies[i + 1].radius - s.r0;
    s.s0 = arc;
    s.s1 = 0.5 * (model.bodies[i].length + model.bodies[i + 1].length);
    arc += s.s1;
    s.obstacle = -1;
    set_curve(p0, p1, p2, p3, s);
  }
}

std::vector<SplineSegment> spline(const Model& model, const Eigen::Matrix3Xd& centre) {
  std::vector<SplineSegment> segments;
  update_spline(model, centre, segments);
  return segments;
}

}  // namespace hagfish
