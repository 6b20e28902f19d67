// The constant description of a chain of rigid bodies: one root, no branches.
//
// Body b spans `length` along its own X axis from its frame, which sits at the joint to the body
// before it (headward); its centre of mass is half way. Body 0 is the head and hangs on a free
// joint of six velocities; every later body hangs on 0 to 3 hinges about its own axes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/chain/muscle.hpp"
#include "core/scene/settings.hpp"
#include "core/scene/specimen.hpp"

namespace hagfish {

struct Body {
  double mass = 0;                                    ///< g
  double length = 0;                                  ///< cm
  double radius = 0;                                  ///< radius of the skin, cm
  Eigen::Vector3d inertia = Eigen::Vector3d::Zero();  ///< moments at the centre, body axes, g cm^2
  int first_dof = 0;                                  ///< index of its first velocity
  int dofs = 0;                                       ///< number of its velocities
};

enum class Axis { x = 0, y = 1, z = 2 };

/// Row of an axis in shapes of the body, which are about Y, about Z, twist (CurvatureProgram).
constexpr int shape_row(Axis axis) { return (static_cast<int>(axis) + 2) % 3; }

/// One angle. A joint with several turns about its axes in the order of its hinges.
struct Hinge {
  int body = 0;
  Axis axis = Axis::y;
  double lower = 0;      ///< rad; -infinity where free
  double upper = 0;      ///< rad; +infinity where free
  double stiffness = 0;  ///< spring towards angle 0, dyn cm / rad
  double damping = 0;    ///< dyn cm s / rad
};

/// A limit on the total angle of a universal joint, whose hinges have none of their own: its second
/// body's X axis stays within a cone about that of its first (core/chain/bending.hpp).
struct BendingCone {
  int dof = 0;       ///< first velocity of the joint; that of its other hinge is the next
  double limit = 0;  ///< rad, below pi/2
};

struct Model {
  std::vector<Body> bodies;   ///< head to tail
  std::vector<Hinge> hinges;  ///< head to tail; hinge k has velocity 6 + k and coordinate 7 + k
  std::vector<BendingCone> cones;   ///< head to tail; none where each hinge has its own limit
  std::vector<Muscle> muscles;      ///< head to tail; none but where the scene has them
  std::vector<Obstacle> obstacles;  ///< obstacles that bodies and skin stay out of
  DragSettings drag;
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< cm / s^2

  int body_count() const { return static_cast<int>(bodies.size()); }
  int muscle_count() const { return static_cast<int>(muscles.size()); }
  int hinge_count() const { return static_cast<int>(hinges.size()); }
  int nv() const { return 6 + hinge_count(); }
  int nq() const { return 7 + hinge_count(); }
  double length() const;  ///< cm
  double mass() const;    ///< g
};

/// Velocities of the free root, always the first of every velocity vector.
inline constexpr int root_dofs = 6;

/// A joint of the paper's Figure 1; its hinges say of which kind.
struct JointName {
  std::string joint;              ///< "root", "j01_bend", "j02_twist"
  std::vector<std::string> dofs;  ///< "root_x", ..., "j01_bend_y"
};

/// Names of joints 0..N-1 and their velocities, as the log and the MJCF give them.
std::vector<JointName> joint_names(const Model& model);

/// Names of the coordinates of q, nq: root_x, root_y, root_z, root_qw, root_qx, root_qy, root_qz,
/// then those of the hinges' velocities: hinge i is q[7 + i] and q̇[6 + i].
std::vector<std::string> coordinate_names(const Model& model);

/// The name of one velocity. Throws std::out_of_range.
std::string dof_name(const Model& model, int dof);

/// The joint of a cone, by the name that joint_names() gives.
std::string cone_joint_name(const Model& model, const BendingCone& cone);

/// The lowest and the highest angle that each hinge can have, 2 x hinges, rad: its own limits or,
/// in a cone, what this leaves it where the other hinge is straight.
Eigen::Matrix2Xd hinge_ranges(const Model& model);

/// The limit on the total angle of joints 0..N-1, rad: their cones', +infinity where none.
Eigen::VectorXd bending_limits(const Model& model);

/// Appends a body that hangs on hinges about `axes` (limits free, no passive force). The caller
/// sets the rest in bodies.back() and hinges. Throws std::invalid_argument for hinges at body 0.
void append_body(Model& model, const Body& body, const std::vector<Axis>& axes);

/// Inertia of a solid homogeneous cylinder along X about its centre, g cm^2.
Eigen::Vector3d cylinder_inertia(double mass, double length, double radius);

/// Length of the animal (cm) that the hinges of joint `body` >= 1 stand for, where all bodies are
/// as long, as in make_hagfish: from half way to the joint of the same kind before it to half way
/// to the one after it, from the head or to the tail where there is none. The spans of a kind add
/// up to the animal; sums over them are integrals along it but for errors of second order in
/// `length`.
double hinge_span(const Model& model, int body);

/// What the animal stays out of: the head plate where there is one, then the scene's others. Their
/// places in this list are their indices everywhere.
std::vector<Obstacle> obstacles_of(const Scene& scene);

/// The animal: universal joints (about Y and Z) and revolute joints (about X) in turn (paper, 3.1),
/// or universal joints alone. Of universal joints every second one turns about Z first. Mass is in
/// proportion to r^2. Stiffness and damping are those of the length of body that a joint stands
/// for, and bending limits those of the distance between bending joints. So the physics per length
/// does not depend on the number of bodies. Scaled by ModelSettings, with the scene's obstacles.
/// Throws std::invalid_argument for a body count outside 2..400.
Model make_hagfish(const Specimen& specimen, const Scene& scene);

}  // namespace hagfish
