// Runs by a film's program: which knot the film shows, and muscles stiff enough to follow it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/chain/model.hpp"
#include "core/input/files/scene_reader.hpp"
#include "core/run/drive.hpp"

namespace hagfish {

/// A knot and which image of it.
struct FilmedKnot {
  std::string name;       ///< knot_name(); "0_1" where there is none
  Hand hand = Hand::any;  ///< any where the knot is its own mirror image, or none
};

/// Knot of an open polygon (3 x n, any unit); "0_1" also where none can be told.
FilmedKnot knot_of(const Eigen::Matrix3Xd& points, const KnotSettings& settings);

/// Knot of a program's shape at one of its times.
FilmedKnot knot_of(const Model& model, const CurvatureProgram& program, std::size_t time,
                   const KnotSettings& settings);

/// `base` with a film's program in place of its own: the animal begins in its first shape,
/// tightens once it is over, and is to tie `knot`, where that is one.
ResolvedScene scene_of_film(ResolvedScene base, const CurvatureProgram& program,
                            const FilmedKnot& knot, double stiffness);

/// Bends of the program's first shape as StartSettings::bend, rounded as a scene file has them.
std::vector<Eigen::Vector4d> first_bends(const Model& model, const CurvatureProgram& program);

struct FilmTrial {
  double stiffness = 0;  ///< ActiveSettings::stiffness, dyn cm^2
  bool lasted = false;   ///< lasted to the program's end
  FilmedKnot knot;       ///< knot at the end
  double rms = 0;        ///< rms distance of the bodies' centres from the program's shapes, cm
};

/// Runs with the scene's stiffness and doubles of it, until two in a row do not last. `watch` sees
/// each step.
std::vector<FilmTrial> try_stiffness(const ResolvedScene& base, const CurvatureProgram& program,
                                     const FilmedKnot& knot, const Watcher& watch);

/// The one that ends with the film's knot and is nearest; of none such, the nearest that lasted.
std::optional<FilmTrial> best_of(const std::vector<FilmTrial>& trials, const FilmedKnot& knot);

}  // namespace hagfish
