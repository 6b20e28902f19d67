// The control laws that a scene may name (controller.law), each a record: what it is called, what
// it keeps, what its scene needs, how it acts, what it logs and what an audit may ask of it. The
// table of them is in laws.cpp, each record beside its law.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/run/control_law.hpp"
#include "core/scene/phase.hpp"
#include "core/scene/specimen.hpp"

namespace hagfish {

/// Storage whose contents do not matter from one step to the next: copies of it begin empty.
template <class T>
struct Scratch : T {
  Scratch() = default;
  Scratch(const Scratch& /*other*/) : Scratch() {}
  Scratch& operator=(const Scratch&) = delete;
};

/// A ControlLaw that calls `law` with storage of its own.
template <class T, void (*law)(const Situation&, Eigen::VectorXd&, Control&, T&)>
ControlLaw law_with_storage() {
  return [storage = Scratch<T>()](const Situation& at, Eigen::VectorXd& memory,
                                  Control& control) mutable { law(at, memory, control, storage); };
}

/// What a key of a scene must be where it has a law, and is not.
struct SceneFault {
  std::string key;                          ///< dotted
  std::string why;                          ///< "must be positive"
  std::optional<std::size_t> element = {};  ///< of the array at the key
};

/// Numbers of a law's memory that logs hold, a row a frame.
struct LawNumbers {
  const char* path;  ///< of the dataset
  const char* unit;
  const char* description;
  /// How many there are; 0: no dataset; nullptr: one for each muscle.
  Eigen::Index (*size)(const Model& model, const Scene& scene) = nullptr;
  /// The `size` numbers in `memory`, which is not empty; where it is, nan are logged.
  Eigen::VectorXd (*of)(const Eigen::VectorXd& memory, Eigen::Index size);
};

/// What an audit knows of a step by what the log has of its start.
struct LoggedSituation {
  const Model& model;
  const Scene& scene;
  const Kinematics& kin;
  const Eigen::VectorXd& q;
  const Eigen::VectorXd& qdot;
  const ContactSet& contacts;
  Phase phase;
  double time;                           ///< s
  std::vector<Eigen::VectorXd> numbers;  ///< of Law::numbers, in their order
};

/// The rows of Eq. 6 at the knot's ends that a law asks for in a phase, beside the paper's.
struct AskedRows {
  bool any = true;                         ///< whether there are any
  double effort = 1;                       ///< share of controller.cap
  double least_scale = 1, most_scale = 1;  ///< of the commanded speeds, the same of all rows
};

struct Law {
  std::string_view name;         ///< in scenes
  std::string_view description;  ///< in one line
  /// The law, ready to be asked, with storage of its own; nullptr: it is of the program that runs
  /// the scene, its memory is of any size and an audit knows no more than its control as logged.
  ControlLaw (*make)();
  /// How many numbers it keeps from step to step, where it keeps any; nullptr: it never does.
  Eigen::Index (*memory_size)(const Model& model, const Scene& scene) = nullptr;
  /// The first thing that keeps a scene from having it; nullptr: nothing does.
  std::optional<SceneFault> (*fault)(const Specimen& specimen, const Scene& scene) = nullptr;

  /// Whether all its rows of Eq. 6 are logged one by one (/eq6): they are not the paper's at the
  /// two ends of the knot, or not all of them.
  bool logs_rows = true;
  std::span<const LawNumbers> numbers = {};

  /// Whether it keeps numbers in a phase, and asks for torques; nullptr: in each.
  bool (*remembers)(Phase phase) = nullptr;
  /// Its rows at the ends; nullptr: the paper's.
  AskedRows (*rows)(const Scene& scene, Phase phase) = nullptr;
  /// The rest shape of the step (nv, 0 at the root), empty where there is none, or nothing where it
  /// is the paper's; nullptr: it always is.
  std::optional<Eigen::VectorXd> (*rest_shape)(const LoggedSituation& at) = nullptr;
  /// Torques besides those towards the rest shape, dyn cm, nv; nullptr: none.
  Eigen::VectorXd (*torque)(const LoggedSituation& at) = nullptr;
};

/// All of them.
std::span<const Law* const> laws();

/// The one that the scene names. Throws std::invalid_argument where there is none of that name.
const Law& law_of(const Scene& scene);

/// Whether `memory` is empty or as long as that of the law that the scene names.
bool fits_law(const Model& model, const Scene& scene, const Eigen::VectorXd& memory);

/// The law that a scene names, made when it is first asked. Copies begin with empty storage.
struct NamedLaw {
  const Law* law = nullptr;
  ControlLaw act;
};

/// Asks the law that the scene names, by `named`. Throws what that does, and std::invalid_argument
/// where it is of the program that runs the scene.
void ask_law(const Situation& at, Eigen::VectorXd& memory, Control& control, NamedLaw& named);

}  // namespace hagfish
