#include "mujoco_ref/log_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "mujoco_ref/mjcf.hpp"
#include "mujoco_ref/mjcf_vocabulary.hpp"

namespace hagfish {
namespace {

/// Compares pair after pair and keeps what it says of the first that differs.
class Comparison {
 public:
  void numbers(const std::string& what, double found, double wanted, const std::string& unit) {
    const bool same = found == wanted ||
                      std::abs(found - wanted) <= 1e-12 * std::abs(wanted);  // or both infinite
    if (!same) note(fmt::format("{}: {:.17g} against {:.17g} {}", what, found, wanted, unit));
  }
  void counts(const std::string& what, int found, int wanted) {
    if (found != wanted) note(fmt::format("{}: {} against {}", what, found, wanted));
  }
  void texts(const std::string& what, const std::string& found, const std::string& wanted) {
    if (found != wanted) note(fmt::format("{}: {} against {}", what, found, wanted));
  }
  const std::string& first() const { return first_; }
  bool same() const { return first_.empty(); }

 private:
  void note(std::string difference) {
    if (first_.empty()) first_ = std::move(difference);
  }
  std::string first_;
};

std::string name_of(const mjModel& mirror, mjtObj type, int id) {
  const char* name = mj_id2name(&mirror, type, id);
  return name == nullptr ? "without a name" : name;
}

void compare_bodies(const mjModel& mirror, const Model& model, Comparison& compare) {
  for (int b = 0; b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    const int id = b + 1;  // the world is MuJoCo's body 0
    const std::string name = "b" + std::to_string(b);
    compare.texts(fmt::format("body {}", b), name_of(mirror, mjOBJ_BODY, id), name);
    compare.numbers("mass of " + name, mirror.body_mass[id], body.mass, "g");
    // Where the centre of mass lies says how long the body is.
    compare.numbers("length of " + name, 2 * mirror.body_ipos[3 * id], body.length, "cm");
    for (int i = 0; i < 3; ++i) {
      compare.numbers(fmt::format("inertia of {} about {}", name, "xyz"[i]),
                      mirror.body_inertia[3 * id + i], body.inertia[i], "g cm^2");
    }
    const bool skin = mirror.body_geomnum[id] > 0;
    compare.numbers("radius of " + name, skin ? mirror.geom_size[3 * mirror.body_geomadr[id]] : 0,
                    body.radius, "cm");
  }
}

void compare_joints(const mjModel& mirror, const Model& model, Comparison& compare) {
  std::vector<std::string> names;
  for (const JointName& joint : joint_names(model)) {
    if (joint.joint == "root") {
      names.push_back(joint.joint);
    } else {
      names.insert(names.end(), joint.dofs.begin(), joint.dofs.end());
    }
  }
  compare.texts("joint 0", name_of(mirror, mjOBJ_JOINT, 0), names[0]);
  for (std::size_t k = 0; k < model.hinges.size(); ++k) {
    const Hinge& hinge = model.hinges[k];
    const int id = static_cast<int>(k) + 1;
    const std::string& name = names[k + 1];
    compare.texts(fmt::format("joint {}", id), name_of(mirror, mjOBJ_JOINT, id), name);
    compare.counts("body of " + name, mirror.jnt_bodyid[id] - 1, hinge.body);
    compare.numbers("axis of " + name, mirror.jnt_axis[3 * id + static_cast<int>(hinge.axis)], 1,
                    "");
    compare.numbers("lower limit of " + name, mirror.jnt_range[2 * id], hinge.lower, "rad");
    compare.numbers("upper limit of " + name, mirror.jnt_range[2 * id + 1], hinge.upper, "rad");
    compare.numbers("stiffness of " + name, mirror.jnt_stiffness[id], hinge.stiffness,
                    "dyn cm/rad");
    compare.numbers("damping of " + name, mirror.dof_damping[root_dofs + k], hinge.damping,
                    "dyn cm s/rad");
  }
}

}  // namespace

MujocoModel mujoco_model_of(const Hdf5Reader& log) {
  std::map<std::string, std::string> files;
  for (const std::string& name : log.names("/mjcf")) {
    files[name] = log.text("/mjcf/" + name);
  }
  if (!files.contains(mjcf_root_file)) {
    throw FileError(log.file() + ": has no /mjcf/" + mjcf_root_file);
  }
  try {
    check_vocabulary(files);
    return MujocoModel(files);
  } catch (const std::runtime_error& error) {
    throw FileError(log.file() + ": /mjcf/" + error.what());
  }
}

std::string first_difference(const mjModel& mirror, const Model& model, double h) {
  Comparison compare;
  compare.counts("number of bodies", mirror.nbody - 1, model.body_count());
  compare.counts("number of velocities", mirror.nv, model.nv());
  compare.counts("number of joints", mirror.njnt, 1 + static_cast<int>(model.hinges.size()));
  if (!compare.same()) {
    return compare.first();  // what follows counts on these
  }
  compare.numbers("timestep", mirror.opt.timestep, h, "s");
  for (int i = 0; i < 3; ++i) {
    compare.numbers(fmt::format("gravity along {}", "xyz"[i]), mirror.opt.gravity[i],
                    model.gravity[i], "cm/s^2");
  }
  compare_bodies(mirror, model, compare);
  compare_joints(mirror, model, compare);
  return compare.first();
}

}  // namespace hagfish
