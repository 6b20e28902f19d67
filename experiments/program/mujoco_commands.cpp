#include "experiments/program/commands.hpp"

namespace hagfish {

std::vector<Registrar> mujoco_commands() {
#ifdef HAGFISH_MUJOCO
  return {add_picture, add_movie, add_mjcf, add_compare, add_integrate, add_playback, add_stress};
#else
  return {};
#endif
}

}  // namespace hagfish
