#include "mujoco_ref/mirror.hpp"

#include <algorithm>
#include <string>

#include "core/step/outcome.hpp"

namespace hagfish {

void set_state(const Model& model, const State& state, MujocoModel& mirror) {
  const mjModel& m = *mirror.model();
  mjData& d = *mirror.data();
  mju_copy(d.qpos, state.q.data() + (model.nq() - m.nq), m.nq);
  mju_copy(d.qvel, state.qdot.data() + (model.nv() - m.nv), m.nv);
}

State state_of(const Model& model, const MujocoModel& mirror) {
  const mjModel& m = *mirror.model();
  const mjData& d = *mirror.data();
  State state = rest_state(model);
  mju_copy(state.q.data() + (model.nq() - m.nq), d.qpos, m.nq);
  mju_copy(state.qdot.data() + (model.nv() - m.nv), d.qvel, m.nv);
  return state;
}

void use_core_rule(MujocoModel& mirror) {
  mjModel& m = *mirror.model();
  m.opt.integrator = mjINT_EULER;
  m.opt.disableflags |= mjDSBL_CONSTRAINT;
  for (int j = 0; j < m.njnt; ++j) {
    if (m.jnt_type[j] == mjJNT_HINGE) {
      m.dof_damping[m.jnt_dofadr[j]] += m.opt.timestep * m.jnt_stiffness[j];
    }
  }
}

void set_stiffness(double constant, double share, mjModel& mirror) {
  const auto set = [&](mjtNum* solref, mjtNum* solimp) {
    solref[0] = constant;
    solimp[0] = share;
    solimp[1] = std::max(share, solimp[1]);
  };
  for (int g = 0; g < mirror.ngeom; ++g) {
    mirror.geom_margin[g] = 0;
    set(mirror.geom_solref + mjNREF * g, mirror.geom_solimp + mjNIMP * g);
  }
  for (int j = 0; j < mirror.njnt; ++j) {
    set(mirror.jnt_solref + mjNREF * j, mirror.jnt_solimp + mjNIMP * j);
  }
}

void check_stable(const MujocoModel& mirror) {
  for (const int kind : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
    const mjWarningStat& warning = mirror.data()->warning[kind];
    if (warning.number > 0) {
      throw StepError(
          {Outcome::non_finite, std::string("MuJoCo: ") + mju_warningText(kind, warning.lastinfo)});
    }
  }
}

}  // namespace hagfish
