// Names of the coordinates of q, as the log gives them.
#pragma once

#include <string>
#include <vector>

#include "core/chain/model.hpp"

namespace hagfish {

/// nq names: root_x, root_y, root_z, root_qw, root_qx, root_qy, root_qz, then those of the hinges'
/// velocities: hinge i is q[7 + i] and q̇[6 + i].
inline std::vector<std::string> coordinate_names(const Model& model) {
  std::vector<std::string> names{"root_x",  "root_y",  "root_z", "root_qw",
                                 "root_qx", "root_qy", "root_qz"};
  for (const JointName& joint : joint_names(model)) {
    if (joint.joint != "root") names.insert(names.end(), joint.dofs.begin(), joint.dofs.end());
  }
  return names;
}

}  // namespace hagfish
