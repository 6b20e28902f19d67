// Flesh that yields: where skins overlap, points along the strands press them apart, f = -k' w g
// at rest, with the gap g < 0 from a point to its foot, the nearest place of the other strand, and
// the length w of strand that the point stands for. Between two parts of the body both have points
// of half the length. Points of one strand alone would be few where the other one winds round it.
// On obstacles all points are the body's; on a ring, which winds round the body, they are its own;
// on a plane they are the bodies' centres.
#pragma once

#include <vector>

#include "core/chain/kinematics.hpp"
#include "core/contact/contact.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// A point and its foot, as a contact between the two.
struct FleshPoint {
  Contact contact;
  int own = 0;           ///< segment of the point
  int number = 0;        ///< its number there
  double weight = 0;     ///< w, cm
  double curvature = 0;  ///< 1/r_a + 1/r_b of both skins, 1/cm
};

/// All points that overlap or may do so in a step, and the energy stored where skins
/// overlap, planes included: Σ ½ k' w g², erg.
struct Flesh {
  std::vector<FleshPoint> points;
  double energy = 0;
};

/// Writes the flesh of `segments`, of bodies placed as `kin`, into `flesh`. `found` are the
/// contacts there: each pair of segments that overlaps is among them. Clears `flesh` where contact
/// is hard.
void find_flesh(const Model& model, const Scene& scene, const Kinematics& kin,
                const std::vector<SplineSegment>& segments, const ContactSet& found, Flesh& flesh);

/// Length of body that presses on a plane at one body's centre, cm.
inline double plane_weight(const Model& model, int body) { return model.bodies[body].length; }

/// Deepest overlap, cm, and pressure at rest, dyn/cm², at each body: 2 x N. The pressure is k' d
/// over the width of the overlap d of two circles, 2 sqrt(2 d / (1/r_a + 1/r_b)).
Eigen::Matrix2Xd flesh_along(const Model& model, const FleshSettings& settings,
                             const Kinematics& kin, const Flesh& flesh);

}  // namespace hagfish
