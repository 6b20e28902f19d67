#include "core/scene/specimen.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/input/files/scene_reader.hpp"

namespace hagfish::specimen_test {

TEST(Specimen, PacificHagfishIsTable1) {
  const Specimen s = read_specimen(HAGFISH_DATA_DIR "/specimens/pacific_hagfish.toml");
  EXPECT_EQ(s.length, 42.4);
  EXPECT_EQ(s.mass, 80);
  EXPECT_EQ(s.station, (std::vector<double>{0.2, 0.4, 0.6, 0.8}));
  EXPECT_EQ(s.circumference, (std::vector<double>{5.6, 5.5, 5.6, 4.3}));
  ASSERT_EQ(s.bending_limit.size(), 4u);
  const double degrees[] = {21, 75, 45, 51};
  // DOUBLE_EQ, 4 ulp: degrees to rad is one rounded product with a rounded factor.
  for (int i = 0; i < 4; ++i) {
    EXPECT_DOUBLE_EQ(s.bending_limit[i], degrees[i] * std::numbers::pi / 180);
  }
  EXPECT_DOUBLE_EQ(s.twist_limit, 48 * std::numbers::pi / 180);
  EXPECT_DOUBLE_EQ(s.bending_span, 2 * s.length / 100);
}

}  // namespace hagfish::specimen_test
