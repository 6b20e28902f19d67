// A tube of rings as MuJoCo's renderer takes it: one skin, whose points and colours change from
// picture to picture.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mujoco_ref/mujoco_model.hpp"

namespace hagfish {

/// A tube in the world, its rings one after another.
struct Skin {
  int sides = 0;                                     ///< points of a ring
  Eigen::Matrix3Xf point, normal;                    ///< 3 x rings * sides, cm; outward, unit
  std::vector<std::array<unsigned char, 3>> colour;  ///< colour of each ring, red, green, blue
  float specular = 0;

  int rings() const { return static_cast<int>(colour.size()); }
};

/// A MuJoCo model with nothing but a skin of so many rings of `sides` points, and a texture with a
/// column for each ring; pictures are of things about as large as `extent`, cm.
MujocoModel skin_model(int rings, int sides, double extent);

}  // namespace hagfish
