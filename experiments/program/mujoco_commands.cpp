#include "experiments/program/commands.hpp"

namespace hagfish {

std::vector<Registrar> mujoco_commands() {
  return {add_picture, add_mjcf, add_compare, add_integrate, add_playback, add_stress};
}

}  // namespace hagfish
