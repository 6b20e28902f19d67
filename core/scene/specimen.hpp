// The measured animal: what Table 1 of the paper lists, its passive stiffness, and nothing of the
// simulation.
#pragma once

#include <string>
#include <vector>

namespace hagfish {

/// The tissue of the body's muscles, known or guessed: lists at the stations.
struct MuscleTissue {
  /// Cross-section of the fibres along the body on each of four sides, left, right, dorsal and
  /// ventral, cm^2. Empty where nothing is said of muscles.
  std::vector<double> longitudinal_area;
  std::vector<double> oblique_area;  ///< oblique fibres of each hand, across them, cm^2
  double stress = 0;                 ///< largest stress of the fibres, dyn / cm^2
  double radius_share = 0;           ///< radius at which they lie, of the skin's
  double oblique_angle = 0;          ///< angle of the oblique fibres to the body's axis, rad
};

/// How the body yields to pressure from the side, known or guessed.
struct FleshTissue {
  /// Least and largest FleshSettings::stiffness that the animal may have, dyn/cm^2; empty where
  /// nothing is said of flesh.
  std::vector<double> stiffness_range;
  /// Share of the area of a section that is left of it at least, as blood and flesh give way along
  /// the body while the skin does not stretch; 0 where nothing is said.
  double least_area = 0;
};

/// A measured specimen (paper, Table 1; what that does not have, by other sources). Profiles are
/// linear between stations and constant outside.
struct Specimen {
  std::string name;
  double length = 0;                  ///< head to tail, cm
  double mass = 0;                    ///< whole body, g
  std::vector<double> station;        ///< places of the profiles, fraction of length, rising
  std::vector<double> circumference;  ///< circumference at the stations, cm
  std::vector<double> bending_limit;  ///< limit at the stations, rad; see bending_span
  /// Length of body over which one bending limit was read, cm. The limits bound each axis of a
  /// universal joint, and the paper's chain of 100 bodies has one such joint per 2 L / 100.
  double bending_span = 0;
  /// Limit measured on the whole body, rad. Each revolute joint may turn by this over the number of
  /// bodies to each side (Table 1), and every second joint is one.
  double twist_limit = 0;
  /// How the dead body resists bending and twisting, at the stations; empty where it was never
  /// measured and not guessed either. Flexural and torsional rigidity, dyn cm^2, and their rate
  /// forms, dyn cm^2 s.
  std::vector<double> bending_stiffness, bending_damping, twist_stiffness, twist_damping;
  MuscleTissue muscle;
  FleshTissue flesh;
};

/// Value at `fraction` of the length of a profile given at `station`.
double profile(const std::vector<double>& station, const std::vector<double>& value,
               double fraction);

/// Diameter of a circle of the circumference, its mean along the body, cm.
double mean_diameter(const Specimen& specimen);

}  // namespace hagfish
