#include "experiments/audit/audit_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/contact/obstacles.hpp"
#include "experiments/audit/row_force.hpp"

namespace hagfish {
namespace {

/// Rows meet their law to what the back end solves, here of each force.
constexpr double force_tolerance = 1e-5;
/// Of energy, overlap and pressure: gaps are sampled.
constexpr double search_tolerance = 0.01;
constexpr int samples = 50;      ///< of a segment
constexpr double across = 1e-4;  ///< of a segment, to either side of a border

int points_on(const SplineSegment& segment, const FleshSettings& flesh) {
  return std::max(1, static_cast<int>(std::lround(segment.s1 / flesh.spacing)));
}

}  // namespace

FleshAudit::FleshAudit(const LogContents& log) : log_(log) {
  if (!log.resolved.scene.flesh.present()) return;
  contacts_ = logged_contacts(log);
  energy_ = log.h5.doubles("/flesh/energy");
  overlap_ = log.h5.doubles("/flesh/overlap");
  pressure_ = log.h5.doubles("/flesh/pressure");
}

/// Length that the point of a logged contact stands for, cm.
double FleshAudit::weight_of(const AuditedFrame& frame, const LoggedContact& contact) const {
  const FleshSettings& flesh = log_.resolved.scene.flesh;
  const SplineSegment& body = frame.segments[spline_point(log_.model, contact.a).first];
  if (contact.obstacle < 0) return 0.5 * body.s1 / points_on(body, flesh);
  const Strand* strand = log_.model.obstacles[contact.obstacle].strand();
  if (strand == nullptr) return log_.model.bodies[static_cast<std::size_t>(contact.a)].length;
  const SplineSegment& own =
      strand->closed ? frame.segments[strand_begin(log_.model, contact.obstacle)] : body;
  return own.s1 / points_on(own, flesh);
}

void FleshAudit::see(const AuditedFrame& frame) {
  const Scene& scene = log_.resolved.scene;
  if (!scene.flesh.present()) return;
  for (; next_contact_ < contacts_.size() && contacts_[next_contact_].frame == frame.index;
       ++next_contact_) {
    const LoggedContact& one = contacts_[next_contact_];
    if (!frame.begins_step || !is_placed(log_.model, one)) continue;
    const Contact now =
        placed_contact(log_.model, frame.observation.kin, frame.observation.segments, one);
    const double speed =
        row_velocity(motion_row(log_.model, push_of(log_, frame, one), one.a, one.b),
                     {frame.step_twist, frame.step_centre_velocity}, frame.qdot_step);
    const double lag = 0.5 * scene.time.step + (now.gap < 0 ? scene.flesh.relaxation : 0);
    const double force = -scene.flesh.stiffness * weight_of(frame, one) * (now.gap + lag * speed);
    rebuilt_.compare("/contacts/force", one.force, force, force_tolerance * std::abs(force));
  }
  Pressed pressed;
  press_strands(frame.observation.segments, pressed);
  press_planes(frame.observation.kin, pressed);
  const auto compare = [&](const char* path, double logged, double wanted) {
    rebuilt_.compare(path, logged, wanted, search_tolerance * wanted);
  };
  const int bodies = log_.model.body_count();
  const auto most = [&](const std::vector<double>& values) {
    return *std::max_element(values.begin() + frame.index * bodies,
                             values.begin() + (frame.index + 1) * bodies);
  };
  compare("/flesh/energy", energy_[static_cast<std::size_t>(frame.index)], pressed.energy);
  compare("/flesh/overlap", most(overlap_), pressed.overlap);
  compare("/flesh/pressure", most(pressure_), pressed.pressure);
}

// Two circles of radii r and R that overlap by d have a chord of 2 sqrt(2 d / (1/r + 1/R)).
void FleshAudit::press(double gap, double weight, double curvature, Pressed& pressed) const {
  if (gap >= 0) return;
  const double stiffness = log_.resolved.scene.flesh.stiffness;
  pressed.energy += 0.5 * stiffness * weight * gap * gap;
  pressed.overlap = std::max(pressed.overlap, -gap);
  pressed.pressure =
      std::max(pressed.pressure, stiffness * -gap / (2 * std::sqrt(-2 * gap / curvature)));
}

/// Every point against every segment of other strands, by samples of the gap along each. A foot is
/// where the gap falls into a segment and rises out of it, or at an end of a strand.
void FleshAudit::press_strands(const std::vector<SplineSegment>& segments, Pressed& pressed) const {
  const Scene& scene = log_.resolved.scene;
  const int count = static_cast<int>(segments.size());
  const auto is_ring = [&](const SplineSegment& s) {
    return s.obstacle >= 0 && log_.model.obstacles[s.obstacle].strand()->closed;
  };
  const auto see_point = [&](const Eigen::Vector3d& x, double r, double weight, const auto& other) {
    const auto gap = [&](int k, double t) {
      return (segments[k].point(t) - x).norm() - segments[k].radius(t) - r;
    };
    const auto same_strand = [&](int k, int next) {
      return next >= 0 && next < count && segments[next].obstacle == segments[k].obstacle &&
             !std::isnan(segments[next].bound);
    };
    for (int k = 0; k < count; ++k) {
      const SplineSegment& s = segments[k];
      if (!other(k) || (s.middle - x).norm() >= s.bound + r) continue;
      const bool first = !same_strand(k, k - 1), last = !same_strand(k, k + 1);
      // Which way the gap goes across the borders of the segment.
      const bool falls = gap(k, across) < (first ? gap(k, 0) : gap(k - 1, 1 - across));
      const bool rises = (last ? gap(k, 1) : gap(k + 1, across)) >= gap(k, 1 - across);
      if (!(falls && rises) && !(first && !falls) && !(last && !rises)) continue;
      double at = first && !falls ? 0 : 1;
      if (falls && rises) {
        int nearest = 0;
        for (int j = 1; j <= samples; ++j) {
          if (gap(k, j / double{samples}) < gap(k, nearest / double{samples})) nearest = j;
        }
        double from = std::max(nearest - 1, 0) / double{samples};
        double to = std::min(nearest + 1, samples) / double{samples};
        while (to - from > across) {  // by thirds
          const double third = (to - from) / 3;
          if (gap(k, from + third) < gap(k, to - third)) {
            to -= third;
          } else {
            from += third;
          }
        }
        at = 0.5 * (from + to);
      }
      press(gap(k, at), weight, 1 / r + 1 / s.radius(at), pressed);
    }
  };
  for (int own = 0; own < count; ++own) {
    const SplineSegment& s = segments[own];
    if (std::isnan(s.bound) || (s.obstacle >= 0 && !is_ring(s))) continue;
    const int points = points_on(s, scene.flesh);
    for (int i = 0; i < points; ++i) {
      const double t = (i + 0.5) / points;
      const auto see = [&](double share, const auto& other) {
        see_point(s.point(t), s.radius(t), share * s.s1 / points, other);
      };
      if (s.obstacle >= 0) {
        see(1, [&](int k) { return segments[k].obstacle < 0; });
        continue;
      }
      see(0.5, [&](int k) {
        const double least = scene.contact.least_arc * (1 - 1e-9);
        return segments[k].obstacle < 0 &&
               std::max(segments[k].s0 - s.arc(1), s.s0 - segments[k].arc(1)) >= least;
      });
      see(1, [&](int k) {
        return segments[k].obstacle >= 0 && !std::isnan(segments[k].bound) && !is_ring(segments[k]);
      });
    }
  }
}

void FleshAudit::press_planes(const Kinematics& kin, Pressed& pressed) const {
  visit_plane_gaps(log_.model, kin, [&](const PlaneGap& at) {
    const Body& body = log_.model.bodies[at.body];
    press(at.gap, body.length, 1 / body.radius, pressed);
  });
}

std::vector<Finding> FleshAudit::findings() const {
  if (!log_.resolved.scene.flesh.present()) return {};
  return {rebuilt_.finding("flesh", "q and q̇ by its law")};
}

}  // namespace hagfish
