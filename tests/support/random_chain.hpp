// Models, states and reference algebra that the tests of core share. Everything random comes from a
// seeded std::mt19937 and is the same on every platform. Units: cm, g, s, rad, dyn.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "core/chain/articulated.hpp"
#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"
#include "core/chain/state.hpp"
#include "core/scene/settings.hpp"
#include "core/scene/specimen.hpp"
#include "core/step/rows/row.hpp"

namespace hagfish {

using Random = std::mt19937;

/// Evenly spread over [low, high).
double uniform(Random& random, double low, double high);
/// Components even over [-size, size).
Eigen::Vector3d random_vector(Random& random, double size = 1);
/// `count` entries even over [-size, size).
Eigen::VectorXd random_entries(Random& random, Eigen::Index count, double size = 1);
/// Unit quaternion, even over all rotations.
Eigen::Quaterniond random_rotation(Random& random);

/// The paper's Table 1: data/specimens/pacific_hagfish.toml.
Specimen table1_specimen();
/// The Table 1 scene without its script, as data/table1.toml gives it, for `bodies` bodies.
Scene table1_scene(int bodies = 100);
/// The hagfish of that scene.
Model table1_hagfish(int bodies = 100);
/// The same with limits on the total angle of its universal joints.
Model cone_hagfish(int bodies = 100);
/// The same with muscles.
Model muscled_hagfish(int bodies = 100);
/// `state` with each universal joint bent back, in its plane, to `share` of its cone at most.
State within_cones(const Model& model, State state, double share = 1);

/// `bodies` cylinders of random mass (0.5 to 2 g), length (0.3 to 1 cm) and radius; every body but
/// the first hangs on 0 to 3 hinges about distinct random axes with limits, stiffness and damping.
Model random_chain(Random& random, int bodies);

/// Any root pose (positions up to 5 cm), hinge angles up to `angle` to either side but inside the
/// limits, velocities up to `speed`.
State random_state(Random& random, const Model& model, double angle = 0.5, double speed = 1);

/// At rest, bent evenly about every Y and Z hinge and twisted about every X hinge, rad per cm of
/// body (each hinge stands for hinge_span of it), head at the origin.
State bent_state(const Model& model, double bend_y, double bend_z, double twist = 0);

/// An open trefoil knot 41.6 cm long, its three crossings about 0.7 `height` cm apart; straight
/// where `share`, 0 to 1 along it, is larger. cm.
Eigen::Vector3d trefoil_point(double share, double height);

/// The hagfish at rest along that knot, head at the origin along +X, each hinge off by up to
/// `noise` rad. At a height of 2.45 without noise three crossings touch, one of them 0.18 cm deep.
State knotted_state(Random& random, const Model& model, double height = 2.45, double noise = 0);

/// Î: symmetric positive definite blocks about O with δ >= 0: random inertias at the centres.
StepOperator random_operator(Random& random, const Model& model, const Kinematics& kin);

/// Largest entry of |x - y| over the largest of |y|.
double relative_error(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y);

}  // namespace hagfish
