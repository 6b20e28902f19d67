#include <cmath>
#include <cstdint>

#include "core/chain/sines.hpp"

namespace hagfish {
namespace {

constexpr double largest_angle = 1e6;  // beyond it the parts of a quarter turn lose digits
constexpr double quarters_per_rad = 6.36619772367581382433e-01;
// A quarter turn in two parts: products of the first one with numbers of turns are exact.
constexpr double quarter = 1.57079632673412561417e+00;
constexpr double quarter_rest = 6.07710050650619224932e-11;
/// Added and taken away, it leaves a whole number.
constexpr double rounding = 0x1.8p52;

/// Sine of `y` + `rest`, within an eighth of a turn. Coefficients of fdlibm's k_sin.c.
double sine_of(double y, double rest) {
  const double z = y * y;
  const double v = z * y;
  const double r = 8.33333333332248946124e-03 +
                   z * (-1.98412698298579493134e-04 +
                        z * (2.75573137070700676789e-06 +
                             z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
  return y - ((z * (0.5 * rest - v * r) - rest) - v * -1.66666666666666324348e-01);
}

/// The same of the cosine, by k_cos.c.
double cosine_of(double y, double rest) {
  const double z = y * y;
  const double r =
      z * (4.16666666666666019037e-02 +
           z * (-1.38888888888741095749e-03 +
                z * (2.48015872894767294178e-05 +
                     z * (-2.75573143513906633035e-07 +
                          z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
  const double half = 0.5 * z;
  const double w = 1 - half;
  return w + (((1 - w) - half) + (z * r - y * rest));
}

}  // namespace

SineCosine plain_sine_and_cosine(double angle) {
  if (!(std::abs(angle) <= largest_angle)) return {std::sin(angle), std::cos(angle)};
  const double turns = (angle * quarters_per_rad + rounding) - rounding;
  const double near = angle - turns * quarter;
  const double away = turns * quarter_rest;
  const double y = near - away;
  const double rest = (near - y) - away;
  const double sine = sine_of(y, rest);
  const double cosine = cosine_of(y, rest);
  const auto quadrant = static_cast<std::uint32_t>(static_cast<std::int32_t>(turns)) & 3U;
  const double s = (quadrant & 1U) != 0 ? cosine : sine;
  const double c = (quadrant & 1U) != 0 ? sine : cosine;
  return {(quadrant & 2U) != 0 ? -s : s, ((quadrant + 1U) & 2U) != 0 ? -c : c};
}

}  // namespace hagfish
