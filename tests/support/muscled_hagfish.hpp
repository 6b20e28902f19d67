// The Table 1 animal with muscles, as data/specimens/pacific_hagfish.toml guesses them.
#pragma once

#include <numbers>

#include "core/muscle/paths.hpp"
#include "tests/support/random_chain.hpp"

namespace hagfish {

inline Specimen muscled_specimen() {
  Specimen fish = table1_specimen();
  fish.muscle = {
      {0.5, 0.48, 0.5, 0.29}, {0.25, 0.24, 0.25, 0.145}, 1e6, 0.6, 0.25 * std::numbers::pi};
  return fish;
}

inline Model muscled_hagfish(int bodies = 100) {
  Scene scene = table1_scene(bodies);
  scene.muscle.present = true;
  return make_hagfish(muscled_specimen(), scene);
}

}  // namespace hagfish
