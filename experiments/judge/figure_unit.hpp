// What numbers of tables count: units in CGS and SI, as names of columns end.
#pragma once

namespace hagfish {

struct FigureUnit {
  const char* cgs;
  const char* si;
  double si_per_cgs;
};
namespace figure_unit {
inline constexpr FigureUnit none{"", "", 1};
inline constexpr FigureUnit second{"s", "s", 1};
inline constexpr FigureUnit radian{"rad", "rad", 1};
inline constexpr FigureUnit centimetre{"cm", "m", 1e-2};
inline constexpr FigureUnit area{"cm2", "m2", 1e-4};
inline constexpr FigureUnit gram{"g", "kg", 1e-3};
inline constexpr FigureUnit per_length{"rad_per_cm", "rad_per_m", 1e2};
inline constexpr FigureUnit speed{"cm_per_s", "m_per_s", 1e-2};
inline constexpr FigureUnit force{"dyn", "N", 1e-5};
inline constexpr FigureUnit newton{"N", "N", 1};
inline constexpr FigureUnit torque{"dyn_cm", "N_m", 1e-7};
inline constexpr FigureUnit torque_time{"dyn_cm_s", "N_m_s", 1e-7};
inline constexpr FigureUnit energy{"erg", "J", 1e-7};
}  // namespace figure_unit

}  // namespace hagfish
