#include "experiments/program/commands.hpp"

namespace hagfish {

std::vector<Registrar> commands() {
  return {add_run,     add_branch,  add_scenes,   add_sweep,   add_record_qp,
          add_qp,      add_info,    add_check,    add_export,  add_view,
          add_figures, add_program, add_midlines, add_against, add_specimen};
}

}  // namespace hagfish
