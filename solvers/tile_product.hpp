// The inner loop of small dense products.
#pragma once

#include <Eigen/Core>

namespace hagfish {

/// Rows of a tile: doubles that fill a vector register of AVX-512, two of AVX, four without flags.
inline constexpr Eigen::Index tile_rows = 8;

using Tile = Eigen::Array<double, tile_rows, tile_rows>;

/// Columns (or rows) of a tile that are worked on together: they take eight registers, whose sums
/// do not wait for each other. All of a tile would not fit where registers are short.
inline constexpr Eigen::Index tile_part = Eigen::internal::packet_traits<double>::size;
static_assert(tile_rows % tile_part == 0);

/// Σ_k u_k v_k' over k < count, with u_k the `tile_rows` entries from left + k left_stride on and
/// v_k those from right + k right_stride on. Each part stays in registers until it is done.
inline Tile tile_product(const double* left, Eigen::Index left_stride, const double* right,
                         Eigen::Index right_stride, Eigen::Index count) {
  using Column = Eigen::Array<double, tile_rows, 1>;
  Tile tile;
  for (Eigen::Index first = 0; first < tile_rows; first += tile_part) {
    Eigen::Array<double, tile_rows, tile_part> part;
    part.setZero();
    const double* u_k = left;
    const double* v_k = right + first;
    for (Eigen::Index k = 0; k < count; ++k, u_k += left_stride, v_k += right_stride) {
      const Column u = Eigen::Map<const Column>(u_k);
      for (int j = 0; j < tile_part; ++j) part.col(j) += u * v_k[j];
    }
    tile.middleCols<tile_part>(first) = part;
  }
  return tile;
}

}  // namespace hagfish
