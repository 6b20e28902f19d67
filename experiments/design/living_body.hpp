// The second stage of a design: the animal ties the knot by its own torques, from many starts, and
// slides it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/input/files/scene_reader.hpp"
#include "experiments/design/soft_body.hpp"
#include "experiments/judge/judge.hpp"

namespace hagfish {

/// The files of a found knot, as they are written and as they are judged.
struct FoundScene {
  std::string scene;    ///< TOML, names the others: program.csv and, where not empty, specimen.toml
  std::string program;  ///< CSV
  std::string specimen;
  std::string knot;         ///< its name
  double tighten_from = 0;  ///< s
};

inline constexpr const char* scene_file = "scene.toml";
inline constexpr const char* program_file = "program.csv";
inline constexpr const char* specimen_file = "specimen.toml";

/// How many times slower than the soft body an animal ties what that tied, in the order in which
/// programs are tried: it has no hand to lead its tail, and its muscles are weaker than that.
inline constexpr double paces[] = {1, 1.5};

/// A curvature program fitted to the `shapes` of the body that was `led`, in the scene of an animal
/// that ties `knot` with it, `slower` times as slowly. `specimen`: text of the animal's file; empty
/// for the base scene's.
FoundScene found_scene(const Model& led, const Shapes& shapes, const std::string& knot,
                       const std::string& specimen, double slower = 1);

/// Other animals that a program is judged by if asked for, for each law, and how many may fail.
inline constexpr int judged_animals = 10, allowed_animals = 3;

/// Other animals: their length over the own one's, and by what share their girth for the length and
/// their limits differ at most.
inline constexpr double shortest_animal = 0.6, longest_animal = 1.4, animal_change = 0.2;

/// The file of such an animal. Muscles and passive stiffness go with the girth. `number`, from 1 to
/// judged_animals: the thickest for its length first, then the thinnest, the second thickest, and
/// so on. They are of four times as many drawn animals, one of each four in the order of thickness,
/// so that they are as thick as animals at large: thick ones tie least.
std::string other_animal(const Specimen& own, unsigned number);

inline constexpr unsigned thickest_animal = 1;

/// The found program in that animal.
FoundScene in_other_animal(const FoundScene& found, const Specimen& own, unsigned number);

/// The control laws by which a found knot is slid: Eq. 6 as the scene has it, and the reflex.
inline constexpr const char* judged_laws[] = {"eq6", "reflex"};

/// One run of a found scene: a law, a start and a time step.
struct Trial {
  int law = 0;      ///< index in judged_laws
  int seed = 0;     ///< seed of noise on every hinge; 0: straight
  double step = 0;  ///< time step, s; 0: the scene's
};

/// Time steps at which a found scene must succeed, too, s.
inline constexpr double finer_steps[] = {0.001, 0.002};

inline constexpr double start_noise_deg = 3;

/// What is changed of the scene for a trial, as after --set.
std::vector<std::string> trial_settings(const Trial& trial);

/// A found scene with such changes.
ResolvedScene resolved_scene(const FoundScene& found, const std::vector<std::string>& set);

/// Runs it to its end. Nothing where `interrupted`.
std::optional<RunSummary> run_trial(const FoundScene& found, const Trial& trial,
                                    const std::function<bool()>& interrupted);

/// Whether the living body has the knot at the end of the program, at steps of 10 ms. False where
/// `interrupted`.
bool repeats(const FoundScene& found, const std::function<bool()>& interrupted);

/// The animal ties the knot, holds it, slides it by both ends and comes off it, within all bounds.
bool succeeds(const RunSummary& run);

/// The reason for failure in a few words; "" of one that succeeds.
std::string shortcoming(const RunSummary& run);

}  // namespace hagfish
