#include "mujoco_ref/skin_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

#include "mujoco_ref/mjcf.hpp"

namespace hagfish {

MujocoModel skin_model(int rings, int sides, double extent) {
  // Any tube will do: each picture has its own points.
  std::vector<double> vertex, texture;
  std::vector<int> face, all, weight;
  for (int k = 0; k < rings; ++k) {
    for (int s = 0; s < sides; ++s) {
      const double turn = 2 * std::numbers::pi * s / sides;
      vertex.insert(vertex.end(), {1.0 * k, std::cos(turn), std::sin(turn)});
      texture.insert(texture.end(), {(k + 0.5) / rings, 0.5});
      all.push_back(k * sides + s);
      weight.push_back(1);
      if (k + 1 == rings) continue;
      const int a = k * sides + s, b = k * sides + (s + 1) % sides;
      face.insert(face.end(), {a, b, a + sides, b, b + sides, a + sides});
    }
  }
  const std::string text = fmt::format(
      R"(<mujoco><statistic extent="{}" center="0 0 0"/><asset>
<texture name="rings" type="2d" builtin="flat" rgb1="1 1 1" width="{}" height="4"/>
<material name="skin" texture="rings"/>
<skin name="skin" material="skin" vertex="{}" texcoord="{}" face="{}">
<bone body="body" bindpos="0 0 0" bindquat="1 0 0 0" vertid="{}" vertweight="{}"/></skin>
</asset><worldbody><body name="body"/></worldbody></mujoco>)",
      extent, rings, fmt::join(vertex, " "), fmt::join(texture, " "), fmt::join(face, " "),
      fmt::join(all, " "), fmt::join(weight, " "));
  return MujocoModel({{mjcf_root_file, text}});
}

}  // namespace hagfish
