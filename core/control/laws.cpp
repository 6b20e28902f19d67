#include "core/control/laws.hpp"

#include <algorithm>
#include <stdexcept>

namespace hagfish {

extern const Law paper_record, all_contacts_record, knot_speed_record, reduced_basis_record,
    muscles_record, reflex_record, reflex_muscles_record;

namespace {

constexpr Law own_record{.name = own_law,
                         .description = "of the C++ or Python program that runs the scene",
                         .make = nullptr,
                         .bends = true,
                         .drives_muscles = true};

constexpr const Law* table[] = {&paper_record,          &all_contacts_record, &knot_speed_record,
                                &reduced_basis_record,  &muscles_record,      &reflex_record,
                                &reflex_muscles_record, &own_record};

}  // namespace

std::span<const Law* const> laws() { return table; }

const Law& law_of(const Scene& scene) {
  const auto found = std::ranges::find(table, scene.controller.law, &Law::name);
  if (found == std::end(table)) {
    throw std::invalid_argument("no control law is called \"" + scene.controller.law + "\"");
  }
  return **found;
}

bool fits_law(const Model& model, const Scene& scene, const Eigen::VectorXd& memory) {
  const Law& law = law_of(scene);
  return memory.size() == 0 || law.make == nullptr ||
         (law.memory_size != nullptr && memory.size() == law.memory_size(model, scene));
}

void ask_law(const Situation& at, Eigen::VectorXd& memory, Control& control, NamedLaw& named) {
  const Law& law = law_of(at.scene);
  if (law.make == nullptr) {
    throw std::invalid_argument(
        R"(controller.law = "own")"
        ": this program must set a control law (Simulation::law) to run the "
        "scene");
  }
  if (named.law != &law) named = {&law, law.make()};
  named.act(at, memory, control);
}

}  // namespace hagfish
