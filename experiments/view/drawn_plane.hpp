// How much of a plane is drawn, in pictures and pages: the same square with the same hole.
#pragma once

#include <algorithm>
#include <vector>

#include "core/scene/obstacle.hpp"

namespace hagfish {

/// Half the side of the head plate, cm.
inline constexpr double drawn_plate_half = 2.6;

/// A square of a plane, in it.
struct DrawnPlane {
  Eigen::Vector3d middle;  ///< world, cm
  double half = 0;         ///< half of its side, cm
  double hole = 0;         ///< radius, about the middle, cm; 0: none
};

/// Whether `strand` closes about a hole of `plane`: flush with it, as the rim of a ring.
inline bool is_rim(const Strand& strand, const Plane& plane) {
  constexpr double rounding = 1e-9;
  return strand.closed && std::ranges::all_of(strand.points, [&](const Eigen::Vector3d& point) {
           return std::abs(plane.normal.dot(point - plane.point)) <= strand.radius + rounding;
         });
}

/// Whether `strand` closes about a hole of any plane of `obstacles`.
inline bool is_rim(const Strand& strand, const std::vector<Obstacle>& obstacles) {
  return std::ranges::any_of(obstacles, [&](const Obstacle& one) {
    return one.plane() != nullptr && is_rim(strand, *one.plane());
  });
}

/// A plane that no body passes: a floor or a wall.
inline bool is_floor(const Plane& plane) { return plane.neck == 0; }

/// The square of `plane`, one of `obstacles`. Its hole ends within the tube of its rim. A
/// floor is as large as an animal of `length` (cm) that lies along X needs.
inline DrawnPlane drawn_plane(const Plane& plane, const std::vector<Obstacle>& obstacles,
                              double length) {
  for (const Obstacle& one : obstacles) {
    if (one.strand() == nullptr || !is_rim(*one.strand(), plane)) continue;
    const Strand& rim = *one.strand();
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const auto& point : rim.points) centre += point / static_cast<double>(rim.points.size());
    const double hole = (rim.points.front() - centre).norm();
    centre -= plane.normal.dot(centre - plane.point) * plane.normal;
    return {centre, std::max(drawn_plate_half, 2 * hole), hole};
  }
  if (!is_floor(plane)) return {plane.point, drawn_plate_half, 0};
  const Eigen::Vector3d animal(0.5 * length, 0, 0);
  return {animal - plane.normal.dot(animal - plane.point) * plane.normal, 0.6 * length, 0};
}

}  // namespace hagfish
