// A film strip has the frames that it is asked for, one after the other.
#include "experiments/mujoco/strip.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/input/files/scene_reader.hpp"
#include "core/input/input_error.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_log.hpp"

namespace hagfish::strip_test {

/// Columns `from` to `from + width` of a picture.
std::vector<unsigned char> part(const Image& image, int from, int width) {
  std::vector<unsigned char> rgb;
  for (int y = 0; y < image.height; ++y) {
    const auto begin = image.rgb.begin() + std::ptrdiff_t{3} * (y * image.width + from);
    rgb.insert(rgb.end(), begin, begin + std::ptrdiff_t{3} * width);
  }
  return rgb;
}

TEST(Strip, HasItsFramesSideBySide) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "swing.h5";
  write_log(file, read_scene_text("base = \"overhand_waypoints\"\n", "test",
                                  {"time.duration=3.0", "time.step=0.02",
                                   "expect.knot=", "expect.types=[]", "expect.slide_distance=0"}));
  const LogContents log(file.string(), LogLevel::frames);
  const PictureSize size{160, 120};
  const Image strip = strip_of(log, {0.5, 2.9, 0.5}, size);
  EXPECT_EQ(strip.width, 480);
  EXPECT_EQ(strip.height, 120);
  EXPECT_EQ(part(strip, 0, 160), part(strip, 320, 160));
  EXPECT_NE(part(strip, 0, 160), part(strip, 160, 160));  // the tail has swung on
  const std::vector<unsigned char> frame = part(strip, 160, 160);
  EXPECT_LT(*std::ranges::min_element(frame), *std::ranges::max_element(frame));
  EXPECT_THROW(strip_of(log, {50}, size), InputError);
  EXPECT_THROW(strip_of(log, {}, size), InputError);
}

}  // namespace hagfish::strip_test
