// What goes with the size of an animal is its own, in the body that is led and in the one that ties
// itself.
#include "experiments/design/living_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "experiments/common/specimen_files.hpp"

namespace hagfish::living_body_test {

/// Shapes of a body that stays straight for a second.
Shapes straight(const SoftBody& body) {
  Shapes shapes;
  for (int k = 0; k <= 10; ++k) shapes.time.push_back(0.1 * k);
  shapes.q = rest_state(body.model).q.transpose().replicate(11, 1);
  return shapes;
}

/// The file of Table 1's animal at another size, with the same proportions.
std::string sized_text(double size) {
  const Specimen own = read_specimen(HAGFISH_DATA_DIR "/specimens/pacific_hagfish.toml");
  Specimen animal = own;
  animal.length *= size;
  animal.bending_span *= size;
  animal.mass *= size * size * size;
  for (double& around : animal.circumference) around *= size;
  return specimen_text(animal, own);
}

TEST(LivingBody, OfAnotherSizeHasMusclesDragAndContactOfItsOwn) {
  const SoftBody own = soft_body("");
  const std::string text = sized_text(1.25);
  const SoftBody larger = soft_body(text);
  const Scene base = resolved_scene(found_scene(own.model, straight(own), "3_1", ""), {}).scene;
  const ResolvedScene other =
      resolved_scene(found_scene(larger.model, straight(larger), "3_1", text), {});
  EXPECT_NEAR(other.specimen.length, 1.25 * own.specimen.length, 1e-4);
  const auto ratio = [](double of, double to) { return of / to; };
  constexpr double rounding = 1e-3;  // of the digits in the files
  EXPECT_NEAR(ratio(other.scene.active.stiffness, base.active.stiffness), std::pow(1.25, 4),
              rounding);
  EXPECT_NEAR(ratio(other.scene.active.capacity, base.active.capacity), std::pow(1.25, 3),
              rounding);
  EXPECT_NEAR(ratio(other.scene.drag.normal, base.drag.normal), 1.25, rounding);
  EXPECT_NEAR(ratio(other.scene.controller.contact_patch, base.controller.contact_patch), 1.25,
              rounding);
  EXPECT_EQ(other.scene.controller.tighten_from, base.controller.tighten_from);
}

TEST(SoftBody, OfAnotherSizeIsLedAsTheFirstOne) {
  // Forces in water go with girth, speed and length; stiffness with that and the length squared.
  const SoftBody own = soft_body("");
  const SoftBody larger = soft_body(sized_text(1.25));
  const Scene &one = own.scene, &other = larger.scene;
  EXPECT_NEAR(other.script.largest_force / one.script.largest_force, std::pow(1.25, 3), 1e-3);
  EXPECT_NEAR(other.script.spring / one.script.spring, std::pow(1.25, 2), 1e-3);
  EXPECT_NEAR(other.model.bending_stiffness / one.model.bending_stiffness, std::pow(1.25, 5), 1e-2);
}

TEST(LivingBody, SlowerProgramsHaveTheSameShapesLater) {
  const SoftBody body = soft_body("");
  const FoundScene one = found_scene(body.model, straight(body), "3_1", "");
  const FoundScene slow = found_scene(body.model, straight(body), "3_1", "", 1.5);
  EXPECT_EQ(slow.tighten_from, 1.5 * one.tighten_from);
  const CurvatureProgram of_one = resolved_scene(one, {}).scene.script.curvature,
                         of_slow = resolved_scene(slow, {}).scene.script.curvature;
  ASSERT_EQ(of_slow.time.size(), of_one.time.size());
  EXPECT_NEAR(of_slow.time.back(), 1.5 * of_one.time.back(), 1e-6);
}

TEST(LivingBody, RepeatsWhatItsProgramTies) {
  const auto never = [] { return false; };
  FoundScene found;
  found.scene = "base = \"living_overhand\"\n";
  EXPECT_TRUE(repeats(found, never));
  found.scene += "[expect]\nknot = \"4_1\"\n";
  EXPECT_FALSE(repeats(found, never));
  EXPECT_FALSE(repeats(found, [] { return true; }));
}

TEST(OtherAnimals, AreTheSameForTheSameNumberAndWithinBounds) {
  const SoftBody body = soft_body("");
  const Specimen& own = body.specimen;
  const FoundScene found = found_scene(body.model, straight(body), "4_1", "");
  std::set<std::string> animals;
  std::vector<double> thickness;
  for (unsigned number = 1; number <= judged_animals; ++number) {
    const FoundScene other = in_other_animal(found, own, number);
    EXPECT_EQ(other.specimen, in_other_animal(found, own, number).specimen);
    EXPECT_EQ(other.program, found.program);
    animals.insert(other.specimen);
    const Specimen animal = resolved_scene(other, {}).specimen;
    const AnimalRatios beside = ratios(animal, own);
    EXPECT_GT(beside.length, 0.6);
    EXPECT_LT(beside.length, 1.4);
    EXPECT_NEAR(beside.thickness(), 1, 0.2);
    thickness.push_back(beside.thickness());
    EXPECT_NEAR(beside.mass, beside.length * beside.girth * beside.girth, 0.1 * beside.mass);
    for (std::size_t k = 0; k < own.bending_limit.size(); ++k) {
      EXPECT_NEAR(animal.bending_limit[k] / own.bending_limit[k], 1, 0.2001);
    }
  }
  EXPECT_EQ(animals.size(), 10U);
  // As many thick as thin ones, the extreme ones first.
  EXPECT_GT(thickness[0], 1.08);
  EXPECT_LT(thickness[1], 0.92);
  EXPECT_NEAR(std::accumulate(thickness.begin(), thickness.end(), 0.0) / 10, 1, 0.02);
}

}  // namespace hagfish::living_body_test
