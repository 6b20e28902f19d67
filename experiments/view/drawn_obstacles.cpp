#include "experiments/view/drawn_obstacles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace hagfish {
namespace {

using Eigen::Vector3d;

/// Whether `strand` closes about a hole of `plane`: flush with it, as the rim of a ring.
bool is_rim(const Strand& strand, const Plane& plane) {
  constexpr double rounding = 1e-9;
  return strand.closed && std::ranges::all_of(strand.points, [&](const Vector3d& point) {
           return std::abs(plane.normal.dot(point - plane.point)) <= strand.radius + rounding;
         });
}

DrawnSquare square_of(const Plane& plane, const std::vector<Obstacle>& obstacles, double length) {
  const auto onto = [&](const Vector3d& point) -> Vector3d {
    return point - plane.normal.dot(point - plane.point) * plane.normal;
  };
  for (const Obstacle& one : obstacles) {
    const Strand* rim = one.strand();
    if (rim == nullptr || !is_rim(*rim, plane)) continue;
    Vector3d centre = Vector3d::Zero();
    for (const auto& point : rim->points) centre += point / static_cast<double>(rim->points.size());
    const double hole = (rim->points.front() - centre).norm();
    return {onto(centre), plane.normal, std::max(drawn_plate_half, 2 * hole), hole};
  }
  if (plane.neck > 0) return {plane.point, plane.normal, drawn_plate_half};
  return {onto({0.5 * length, 0, 0}), plane.normal, 0.6 * length, 0, true};
}

std::string json(const Vector3d& v) { return fmt::format("[{},{},{}]", v.x(), v.y(), v.z()); }

std::string json(const DrawnSquare& square) {
  return fmt::format(R"({{"point":{},"normal":{},"half":{},"hole":{},"floor":{}}})",
                     json(square.middle), json(square.normal), square.half, square.hole,
                     square.floor);
}

std::string json(const DrawnTube& tube) {
  std::vector<std::string> points;
  for (const Vector3d& point : tube.strand.points) points.push_back(json(point));
  return fmt::format(R"({{"points":[{}],"radius":{},"closed":{},"ring":{}}})",
                     fmt::join(points, ","), tube.strand.radius, tube.strand.closed, tube.ring);
}

}  // namespace

std::vector<DrawnObstacle> drawn_obstacles(const std::vector<Obstacle>& obstacles, double length) {
  std::vector<DrawnObstacle> drawn;
  for (const Obstacle& one : obstacles) {
    if (const Plane* plane = one.plane()) {
      drawn.emplace_back(square_of(*plane, obstacles, length));
      continue;
    }
    const Strand& strand = *one.strand();
    const bool rim = std::ranges::any_of(obstacles, [&](const Obstacle& other) {
      return other.plane() != nullptr && is_rim(strand, *other.plane());
    });
    drawn.emplace_back(DrawnTube{strand, strand.closed && !rim});
  }
  return drawn;
}

std::string drawn_obstacles_json(const std::vector<Obstacle>& obstacles, double length) {
  std::vector<std::string> all;
  for (const DrawnObstacle& drawn : drawn_obstacles(obstacles, length)) {
    all.push_back(std::visit([](const auto& one) { return json(one); }, drawn));
  }
  return fmt::format("[{}]", fmt::join(all, ","));
}

}  // namespace hagfish
