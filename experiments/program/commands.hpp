// The subcommands of `hagfish`, listed by hand: what registers itself by a static object is dropped
// when it comes from a static library.
#pragma once

#include <vector>

#include "experiments/program/program.hpp"

namespace hagfish {

/// In the order of `hagfish --help`.
std::vector<Registrar> commands();
void add_run(Program& program);
void add_branch(Program& program);
void add_scenes(Program& program);
void add_sweep(Program& program);
void add_record_qp(Program& program);
void add_qp(Program& program);
void add_info(Program& program);
void add_check(Program& program);
void add_export(Program& program);
void add_view(Program& program);
void add_figures(Program& program);
void add_program(Program& program);
void add_midlines(Program& program);
void add_against(Program& program);
void add_specimen(Program& program);

/// Those that need MuJoCo, which come after; none where the program is built without it.
std::vector<Registrar> mujoco_commands();
void add_picture(Program& program);
void add_movie(Program& program);
void add_mjcf(Program& program);
void add_compare(Program& program);
void add_integrate(Program& program);
void add_playback(Program& program);
void add_stress(Program& program);

}  // namespace hagfish
