// The control laws that a scene may name (controller.law). Each is a record: its name, its memory,
// what its scene needs, how it acts, what it logs and whether it asks for Eq. 6. The table of all
// laws is in laws.cpp; each record is beside its law.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/control/control_law.hpp"
#include "core/scene/phase.hpp"
#include "core/scene/specimen.hpp"

namespace hagfish {

/// Storage whose contents do not matter from one step to the next. Copies of it begin empty.
template <class T>
struct Scratch : T {
  Scratch() = default;
  Scratch(const Scratch& /*other*/) : Scratch() {}
  Scratch& operator=(const Scratch&) = delete;
};

/// A ControlLaw that calls `law` with its own storage.
template <class T, void (*law)(const Situation&, Eigen::VectorXd&, Control&, T&)>
ControlLaw law_with_storage() {
  return [storage = Scratch<T>()](const Situation& at, Eigen::VectorXd& memory,
                                  Control& control) mutable { law(at, memory, control, storage); };
}

/// A key of a scene that does not fit the scene's law, and the reason.
struct SceneFault {
  std::string key;                          ///< dotted
  std::string why;                          ///< "must be positive"
  std::optional<std::size_t> element = {};  ///< element of the array at the key
};

/// Numbers of a law's memory that a log holds, one row for each frame.
struct LawNumbers {
  const char* path;  ///< path of the dataset
  const char* unit;
  const char* description;
  /// How many there are. 0: no dataset; nullptr: one for each muscle.
  Eigen::Index (*size)(const Model& model, const Scene& scene) = nullptr;
  /// The `size` numbers in a `memory` that is not empty. For an empty memory nan are logged.
  Eigen::VectorXd (*of)(const Eigen::VectorXd& memory, Eigen::Index size);
};

struct Law {
  std::string_view name;         ///< name in scenes
  std::string_view description;  ///< description in one line
  /// Makes the law, with its own storage. nullptr: the law belongs to the program that runs the
  /// scene. Its memory then has any size, and its run cannot be made again from the log.
  ControlLaw (*make)();
  /// How many numbers it keeps from step to step while it keeps any. nullptr: it never does.
  Eigen::Index (*memory_size)(const Model& model, const Scene& scene) = nullptr;
  /// The first setting because of which a scene cannot have this law. nullptr: any scene can.
  std::optional<SceneFault> (*fault)(const Specimen& specimen, const Scene& scene) = nullptr;

  /// Whether each of its rows of Eq. 6 is logged (/eq6). False for laws whose rows are all the
  /// paper's, at the two ends of the knot.
  bool logs_rows = true;
  std::span<const LawNumbers> numbers = {};

  /// Whether it asks for Eq. 6 while the knot slides.
  bool asks_for_eq6 = true;
  /// Whether it gives the animal a rest shape where no curvature program does.
  bool bends = false;
  /// Whether muscles move the animal by their activations.
  bool drives_muscles = false;
  /// Its own table in [controller], empty where it has none.
  std::string_view table = {};
};

/// All laws.
std::span<const Law* const> laws();

/// The law that the scene names. Throws std::invalid_argument if there is none of that name.
const Law& law_of(const Scene& scene);

/// Whether `memory` is empty or as long as that of the law that the scene names.
bool fits_law(const Model& model, const Scene& scene, const Eigen::VectorXd& memory);

/// The law that a scene names, made at its first call. Copies begin with empty storage.
struct NamedLaw {
  const Law* law = nullptr;
  ControlLaw act;
};

/// Calls the law that the scene names, by `named`. Throws what the law throws, and
/// std::invalid_argument if the law belongs to the program that runs the scene.
void ask_law(const Situation& at, Eigen::VectorXd& memory, Control& control, NamedLaw& named);

}  // namespace hagfish
