#include "experiments/mujoco/strip.hpp"

#include <algorithm>

#include "core/input/input_error.hpp"

namespace hagfish {

Image strip_of(const LogContents& log, const std::vector<double>& times, PictureSize size) {
  if (times.empty()) throw InputError("a film strip needs a time");
  const FramePictures pictures(log, usual_pitch, usual_yaw);
  Shown shown;
  for (const double time : times) pictures.add(frame_at(log, time), shown);
  View view = pictures.view();
  pictures.fit(shown, size, view);
  const auto renderer = pictures.renderer(size, {});
  Image strip{size.width * static_cast<int>(times.size()), size.height, {}};
  strip.rgb.resize(std::size_t{3} * strip.width * strip.height);
  const auto row = std::ptrdiff_t{3} * size.width;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const Image frame = pictures.draw(*renderer, frame_at(log, times[k]), view);
    for (int y = 0; y < size.height; ++y) {
      std::copy_n(frame.rgb.begin() + y * row, row,
                  strip.rgb.begin() + y * row * static_cast<std::ptrdiff_t>(times.size()) +
                      static_cast<std::ptrdiff_t>(k) * row);
    }
  }
  return strip;
}

}  // namespace hagfish
