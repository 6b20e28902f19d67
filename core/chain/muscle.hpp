// The muscles of the chain (addition: the paper has torques, and closes with the wish for
// contractile fibres): what they are made of. How they pull is core/muscle/'s subject.
//
// A bending joint has four lines along the body, a pair of antagonists for each of its hinges; a
// twisting joint has two families of oblique lines around the body, one wound like a right-handed
// screw and one like a left-handed one. Both lie at a share of the skin's measured radius.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/scene/specimen.hpp"

namespace hagfish {

struct Model;

/// A straight line of fibres across a joint.
struct MuscleLine {
  Eigen::Vector3d head;  ///< its end on the body before the joint, in that body's frame, cm
  Eigen::Vector3d tail;  ///< its end on the body behind it, in that body's frame, cm
};

/// Lines that are active together, between two neighbouring bodies: it turns the hinges of one
/// joint and of no other.
struct Muscle {
  std::string name;  ///< "j01_left"
  int body = 0;      ///< body behind its joint, >= 1
  double force = 0;  ///< F_max of each of its lines, dyn
  std::vector<MuscleLine> lines;
};

/// The muscles of the chain `model` by what the specimen has (Specimen::muscle), joint by joint
/// from the head; at a bending joint left, right, dorsal, ventral, at a twisting one right_handed,
/// left_handed. The animal's left is -y, its back is +z.
std::vector<Muscle> muscles_of(const Specimen& specimen, const Model& model);

}  // namespace hagfish
