#include "experiments/audit/audit_flesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/contact/obstacles.hpp"
#include "experiments/audit/row_force.hpp"

namespace hagfish {
namespace {

/// Rows meet their law to what the back end solves, here of each force.
constexpr double force_tolerance = 1e-5;
/// Of the energy: gaps are sampled, and a minimum on a border where the taper changes is a little
/// off.
constexpr double energy_tolerance = 0.01;
constexpr int samples = 24;  ///< of a segment

int points_on(const SplineSegment& segment, const FleshSettings& flesh) {
  return std::max(1, static_cast<int>(std::lround(segment.s1 / flesh.spacing)));
}

}  // namespace

FleshAudit::FleshAudit(const LogContents& log) : log_(log) {
  if (!log.resolved.scene.flesh.present()) return;
  contacts_ = logged_contacts(log);
  energy_ = log.h5.doubles("/flesh/energy");
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
    const Contact there = placed_contact(log_.model, frame.kin, frame.segments, one);
    const double speed =
        row_velocity(motion_row(log_.model, there.normal, one.a, one.b),
                     {frame.step_twist, frame.step_centre_velocity}, frame.qdot_step);
    const double lag = 0.5 * scene.time.step + (now.gap < 0 ? scene.flesh.relaxation : 0);
    const double force = -scene.flesh.stiffness * weight_of(frame, one) * (now.gap + lag * speed);
    rebuilt_.compare("/contacts/force", one.force, force, force_tolerance * std::abs(force));
  }
  const double energy =
      stored_between_strands(frame.observation.segments) + stored_in_planes(frame.observation.kin);
  rebuilt_.compare("/flesh/energy", energy_[static_cast<std::size_t>(frame.index)], energy,
                   energy_tolerance * energy);
}

/// Every point against every segment of other strands, by samples of the gap along each.
double FleshAudit::stored_between_strands(const std::vector<SplineSegment>& segments) const {
  const Scene& scene = log_.resolved.scene;
  const int count = static_cast<int>(segments.size());
  double energy = 0;
  const auto is_ring = [&](const SplineSegment& s) {
    return s.obstacle >= 0 && log_.model.obstacles[s.obstacle].strand()->closed;
  };
  const auto see_point = [&](const Eigen::Vector3d& x, double r, double weight, const auto& other) {
    std::vector<double> gap;  // along one strand after the other, with a border between them
    for (int k = 0; k < count; ++k) {
      const SplineSegment& s = segments[k];
      const bool near = other(k) && (s.middle - x).norm() < s.bound + r;
      for (int j = 0; j <= samples; ++j) {
        const double t = static_cast<double>(j) / samples;
        if (j == 0 && !gap.empty() && !std::isinf(gap.back())) continue;  // as the end before
        gap.push_back(near ? (s.point(t) - x).norm() - s.radius(t) - r : INFINITY);
      }
    }
    gap.push_back(INFINITY);
    for (std::size_t j = 0; j + 1 < gap.size(); ++j) {
      const double before = j == 0 ? INFINITY : gap[j - 1];
      if (!(gap[j] < 0 && gap[j] <= before && gap[j] < gap[j + 1])) continue;
      const double bend = before - 2 * gap[j] + gap[j + 1];
      const double dip =
          std::isfinite(bend) && bend > 0 ? std::pow(gap[j + 1] - before, 2) / (8 * bend) : 0;
      energy += 0.5 * scene.flesh.stiffness * weight * std::pow(gap[j] - dip, 2);
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
  return energy;
}

double FleshAudit::stored_in_planes(const Kinematics& kin) const {
  double energy = 0;
  visit_plane_gaps(log_.model, kin, [&](const PlaneGap& at) {
    energy += 0.5 * log_.resolved.scene.flesh.stiffness * log_.model.bodies[at.body].length *
              std::pow(std::min(at.gap, 0.0), 2);
  });
  return energy;
}

std::vector<Finding> FleshAudit::findings() const {
  if (!log_.resolved.scene.flesh.present()) return {};
  return {rebuilt_.finding("flesh", "q and q̇ by its law")};
}

}  // namespace hagfish
