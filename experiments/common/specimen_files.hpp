// Files of an animal that was measured, made beside the animal of the paper: what was not measured
// is that one's, scaled.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/input/scene_text.hpp"

namespace hagfish {

/// The volume of round cross-sections, cm^3.
double volume_of(const Specimen& animal);

/// An animal over the paper's: each figure a factor.
struct AnimalRatios {
  double length = 1, girth = 1, mass = 1, limits = 1;  ///< girth: of the mean diameter
  /// Of the girth alone: of passive and active stiffness (its fourth power), of the muscles'
  /// torques (third: area times arm) and of the drag for each length of body (first).
  double stiffness() const;
  double torque() const;
  double drag() const { return girth; }
  /// Girth for its length.
  double thickness() const { return girth / length; }
};

/// `limits`: of the least station.
AnimalRatios ratios(const Specimen& animal, const Specimen& paper);

/// The specimen file: what is not in `animal` is `paper`'s, scaled.
std::string specimen_text(const Specimen& animal, const Specimen& paper);

/// Scales what of the paper's animal's `scene` goes with the size of an animal: lengths across the
/// body with the girth, torques, stiffness and drag as in AnimalRatios. A smaller animal's step is
/// halved as often as its length is.
void go_with_size(Scene& scene, const AnimalRatios& beside);

/// Tables of `base` for `animal`, as TOML: each table's name, and its lines.
std::vector<std::pair<std::string, std::string>> sized_tables(const Specimen& animal,
                                                              const ResolvedScene& base);

/// The scene file: `base`, the built-in scene `base_name`, with the animal of `file`.
std::string specimen_scene_text(const Specimen& animal, const std::string& file,
                                const std::string& base_name, const ResolvedScene& base);

}  // namespace hagfish
