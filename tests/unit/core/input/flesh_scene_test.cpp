// Flesh as scenes and specimens spell it, and what is refused.
#include <gtest/gtest.h>

#include "tests/support/plain_scene.hpp"

namespace hagfish::flesh_scene_test {

const std::string flesh = "[flesh]\nstiffness = 1e5\nrelaxation = 0.015\nspacing = 0.2\n";
const std::string tissue = "[specimen.flesh]\nleast_area = 0.75\n";

/// A slit of this width, between two poles.
std::string slit(double width) {
  std::string text;
  for (const double side : {-1.0, 1.0}) {
    const std::string y = std::to_string(side * (0.5 * width + 0.3));
    text += "[[obstacle]]\nkind = 'strand'\nname = '" + std::string(side < 0 ? "left" : "right") +
            "'\npoints = [[20, " + y + ", -9], [20, " + y + ", 9]]\nradius = 0.3\n";
  }
  return text;
}

std::string complaint(const std::string& more) {
  return error_of([&] { read_scene_text(more + plain_scene + tissue, "s.toml"); });
}

TEST(FleshScene, NeedsRelaxationAndSpacing) {
  EXPECT_EQ(complaint("[flesh]\nstiffness = 1e5\nspacing = 0.2\n"),
            "s.toml: flesh.relaxation: must be positive where flesh.stiffness is");
  EXPECT_EQ(complaint("[flesh]\nstiffness = 1e5\nrelaxation = 0.01\n"),
            "s.toml: flesh.spacing: must be positive where flesh.stiffness is");
}

// The body is 5 / pi = 1.59 cm thick, and passes half of that.
TEST(FleshScene, RefusesASlitTooNarrowForTheVolume) {
  EXPECT_EQ(complaint(flesh + slit(0.81)), "no error");
  EXPECT_NE(complaint(flesh + slit(0.78)).find("too narrow for the volume of the body"),
            std::string::npos);
  EXPECT_EQ(complaint(flesh + slit(-0.1)), "no error");  // touching poles leave no slit
  // Hard bodies do not overlap at the start.
  EXPECT_NE(complaint(slit(0.81)).find("overlaps body"), std::string::npos);
}

// A hole keeps the share (ρ / r)² of the area: at least 0.866 of the radius, 0.69 cm.
TEST(FleshScene, RefusesAHoleTooNarrowForTheVolume) {
  const auto hole = [](double radius) {
    return "[[obstacle]]\nkind = 'ring'\ncentre = [20, 0, 0]\naxis = [1, 0, 0]\nradius = 0.3\n"
           "inner_radius = " +
           std::to_string(radius) + "\n";
  };
  EXPECT_EQ(complaint(flesh + hole(0.70)), "no error");
  EXPECT_NE(complaint(flesh + hole(0.68)).find("the hole is too narrow"), std::string::npos);
  EXPECT_NE(complaint(hole(0.70)).find("the hole is too narrow"), std::string::npos);
}

}  // namespace hagfish::flesh_scene_test
