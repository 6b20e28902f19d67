// What obstacles look like, for all that draws them: pictures, films, replays and the live page.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/scene/obstacle.hpp"

namespace hagfish {

/// Half the side of the head plate, cm.
inline constexpr double drawn_plate_half = 2.6;

/// A square of a plane, in it.
struct DrawnSquare {
  Eigen::Vector3d middle;  ///< world, cm
  Eigen::Vector3d normal;  ///< unit, world
  double half = 0;         ///< half of its side, cm
  double hole = 0;         ///< radius, about the middle, cm; 0: none
  bool floor = false;      ///< no body passes it, and it goes on beyond the square
};

/// A tube with round ends.
struct DrawnTube {
  Strand strand;
  bool ring = false;  ///< closed about no hole: what is in it shall be seen
};

using DrawnObstacle = std::variant<DrawnSquare, DrawnTube>;

/// One for each of `obstacles`, in their order. A hole ends within the tube of its rim, the ring
/// that is flush with the plane. A floor is as large as an animal of `length` (cm) that lies along
/// X needs.
std::vector<DrawnObstacle> drawn_obstacles(const std::vector<Obstacle>& obstacles, double length);

/// The same as JSON, which view/body.js draws.
std::string drawn_obstacles_json(const std::vector<Obstacle>& obstacles, double length);

}  // namespace hagfish
