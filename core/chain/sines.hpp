// Sines and cosines of angles.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace hagfish {

struct SineCosine {
  double sine, cosine;
};

/// Sine and cosine of an angle, rad, to two units in the last place. In builds for any processor
/// (HAGFISH_NATIVE=OFF) by plain_sine_and_cosine(), whose bits are the same everywhere; in others
/// by the C library.
SineCosine sine_and_cosine(double angle);

/// Sine and cosine by arithmetic alone, with the same bits from any compiler that does not contract
/// it: the kernels of Sun's fdlibm. To two units in the last place, or to 1e-26 of the angle where
/// they are nearly 0. Past 1e6 rad by the C library.
SineCosine plain_sine_and_cosine(double angle);

/// Sines and cosines of `angles` (rad), to two units in the last place; exactly odd and even, so
/// that mirror images stay so. A build for the processor that it is on works several out at once
/// where the C library has a function for that.
void sines_and_cosines(const Eigen::Ref<const Eigen::VectorXd>& angles, Eigen::VectorXd& sine,
                       Eigen::VectorXd& cosine);

#if defined(HAGFISH_LIBRARY_SINES)
inline SineCosine sine_and_cosine(double angle) { return {std::sin(angle), std::cos(angle)}; }
#else
inline SineCosine sine_and_cosine(double angle) { return plain_sine_and_cosine(angle); }
#endif

}  // namespace hagfish
