// The model as MJCF, the file format of MuJoCo (written for version 2.2.2).
//
// Positions and velocities have the layout of core/chain/state.hpp, so a log replays as it is. What
// the two simulators share: bodies with their inertias, joints with limits, stiffness and damping,
// the skin as frictionless capsules, gravity, and obstacles: strands as capsules, planes as planes.
// What is left out: planes with a neck, as the head plate, since MuJoCo knows no bodies that pass
// through one, water drag, which MuJoCo knows only in other forms, limits on the total angle of a
// joint (the root document says so), since MuJoCo limits hinges one by one, and all that belongs to
// a scene: script, the active torques of muscles, controller. Muscles, where the model has them,
// are spatial tendons with general actuators, whose controls are activations: 0 but where someone
// sets them.
#pragma once

#include <map>
#include <string>

#include "core/chain/model.hpp"

namespace hagfish {

/// Name of the root document among the files of one model.
inline constexpr const char* mjcf_root_file = "hagfish.xml";

/// How the head hangs on the world. A clamped head is part of it, at the origin along +X: MuJoCo's
/// q and q̇ are then the core's without the root's 7 and 6 entries.
enum class Head { free, clamped };

/// Texts by file name of `model` with the timestep `h` (s): the root document and the files it
/// includes, 11 in all for 400 bodies. Units are cm, g, s, rad; numbers read back to the last bit.
///
/// Bodies are named b0, b1, ... head to tail, joints by the dofs of joint_names(), the free joint
/// "root". A body of radius 0 has no geom. Capsules with less body than `least_arc` between them
/// (cm; ContactSettings::least_arc) never touch, as in core/contact/contact.cpp.
/// MuJoCo rejects a limited hinge whose lower limit is not below its upper one.
std::map<std::string, std::string> mjcf_files(const Model& model, double least_arc, double h,
                                              Head head = Head::free);

/// The same as one document, of mjcf_files(): for loaders without nested includes, as MuJoCo 3 is
/// where there are tendons. Each body is one level deeper, and MuJoCo 2.2 reads no more than 96.
std::string flat_mjcf(const std::map<std::string, std::string>& files);

}  // namespace hagfish
