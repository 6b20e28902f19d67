#include "experiments/program/program.hpp"

namespace hagfish {

// Each registers itself by a function in its own file, NAME_command.cpp.
void add_run(Program&), add_branch(Program&), add_scenes(Program&), add_sweep(Program&),
    add_sure(Program&), add_record_qp(Program&), add_qp(Program&), add_info(Program&),
    add_check(Program&), add_export(Program&), add_view(Program&), add_figures(Program&),
    add_program(Program&), add_midlines(Program&), add_against(Program&), add_specimen(Program&),
    add_design(Program&), add_animal(Program&);
// Those in mujoco/ need it.
void add_picture(Program&), add_movie(Program&), add_mjcf(Program&), add_compare(Program&),
    add_integrate(Program&), add_playback(Program&), add_mujoco_run(Program&), add_stress(Program&);

std::vector<Registrar> commands() {
  return {
      add_run,        add_branch,   add_scenes,  add_sweep,    add_sure,      add_record_qp,
      add_qp,         add_info,     add_check,   add_export,   add_view,      add_figures,
      add_program,    add_midlines, add_against, add_specimen, add_design,    add_animal,
#ifdef HAGFISH_MUJOCO
      add_picture,    add_movie,    add_mjcf,    add_compare,  add_integrate, add_playback,
      add_mujoco_run, add_stress,
#endif
  };
}

}  // namespace hagfish
