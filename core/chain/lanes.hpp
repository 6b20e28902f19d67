// Numbers that are worked on side by side, one in each lane of a vector register: eight doubles
// with AVX-512, two without any flag. By the vector extensions of GCC and Clang; lanes do not mix.
// Their number changes results by the last bits of root() alone.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>

namespace hagfish {

/// Doubles in a register of the processor that the code is compiled for.
inline constexpr int lane_count = Eigen::internal::packet_traits<double>::size;

using Lanes = double __attribute__((vector_size(lane_count * sizeof(double))));
/// All bits of a lane are set where a comparison holds: `mask ? x : y` chooses lane by lane.
using LaneMask = std::int64_t __attribute__((vector_size(lane_count * sizeof(double))));

/// One number for each lane, to be set one by one: faster than lanes themselves.
using LaneValues = std::array<double, lane_count>;

namespace detail {
/// Reads the bytes of `from` as another type.
template <class To, class From>
To bits_as(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  // Eigen's arrays of fixed size are their numbers and no more.
  // NOLINTNEXTLINE(bugprone-undefined-memory-manipulation)
  std::memcpy(static_cast<void*>(&to), &from, sizeof to);
  return to;
}
}  // namespace detail

inline Lanes lanes_of(const LaneValues& values) { return detail::bits_as<Lanes>(values); }
/// One number in all lanes.
inline Lanes lanes_of(double value) { return Lanes{} + value; }

/// Lanes in single precision: twice as many.
inline constexpr int float_lane_count = 2 * lane_count;
using FloatLanes = float __attribute__((vector_size(float_lane_count * sizeof(float))));
using FloatLaneMask = std::int32_t __attribute__((vector_size(float_lane_count * sizeof(float))));

using FloatLaneValues = std::array<float, float_lane_count>;

inline FloatLanes lanes_of(const FloatLaneValues& values) {
  return detail::bits_as<FloatLanes>(values);
}

/// Whether a mask is set in any lane.
inline bool any(const LaneMask& mask) {
#if defined(EIGEN_VECTORIZE_AVX512)
  return _mm512_cmplt_epi64_mask(detail::bits_as<__m512i>(mask), _mm512_setzero_si512()) != 0;
#elif defined(EIGEN_VECTORIZE_AVX)
  return _mm256_movemask_pd(detail::bits_as<__m256d>(mask)) != 0;
#elif defined(EIGEN_VECTORIZE_SSE2)
  return _mm_movemask_pd(detail::bits_as<__m128d>(mask)) != 0;
#else
  bool found = false;
  for (int k = 0; k < lane_count; ++k) found = found || mask[k] != 0;
  return found;
#endif
}

/// The lesser of two numbers, or of those in each lane.
template <class Real>
Real least(const Real& x, const Real& y) {
  return x < y ? x : y;
}
inline Lanes largest(const Lanes& x, const Lanes& y) { return x > y ? x : y; }
inline Lanes magnitude(const Lanes& x) { return largest(x, -x); }

/// Square root to two units in the last place, of finite numbers; 0 below the smallest normal one.
inline Lanes root(const Lanes& x) {
  using Values = Eigen::Array<double, lane_count, 1>;
  return detail::bits_as<Lanes>(Values(detail::bits_as<Values>(x).sqrt()));
}
inline FloatLanes root(const FloatLanes& x) {
  using Values = Eigen::Array<float, float_lane_count, 1>;
  return detail::bits_as<FloatLanes>(Values(detail::bits_as<Values>(x).sqrt()));
}

/// A vector of space in each lane.
struct LaneVector {
  Lanes x, y, z;
};

inline LaneVector operator+(const LaneVector& a, const LaneVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline LaneVector operator-(const LaneVector& a, const LaneVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline LaneVector operator*(const Lanes& s, const LaneVector& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline LaneVector operator*(double s, const LaneVector& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Lanes dot(const LaneVector& a, const LaneVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

}  // namespace hagfish
