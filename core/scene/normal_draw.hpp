// Draws from the normal distribution that are the same on every platform.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

namespace hagfish {

/// Standard normal (Box and Muller), from the generator's bits.
inline double normal_draw(std::mt19937& random) {
  const double u = (static_cast<double>(random()) + 0.5) * 0x1p-32;
  const double v = static_cast<double>(random()) * 0x1p-32;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

}  // namespace hagfish
