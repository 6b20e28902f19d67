// A muscle of the chain: what it is made of. Where it pulls is muscle_paths.hpp's subject.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hagfish {

/// A straight line of fibres across a joint.
struct MuscleLine {
  Eigen::Vector3d head;  ///< its end on the body before the joint, in that body's frame, cm
  Eigen::Vector3d tail;  ///< on the body behind it, in that body's frame, cm
};

/// Lines that are active together, between two neighbouring bodies: it turns the hinges of one
/// joint and of no other.
struct Muscle {
  std::string name;  ///< "j01_left"
  int body = 0;      ///< behind its joint, >= 1
  double force = 0;  ///< F_max of each of its lines, dyn
  std::vector<MuscleLine> lines;
};

}  // namespace hagfish
