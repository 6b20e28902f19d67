// The inner loop of small dense products.
#pragma once

#include <Eigen/Core>

namespace hagfish {

/// Rows of a tile: doubles that fill a vector register.
inline constexpr Eigen::Index tile_rows = 8;

using Tile = Eigen::Array<double, tile_rows, tile_rows>;

/// Σ_k u_k v_k' over k < count, with u_k the `tile_rows` entries from left + k left_stride on and
/// v_k those from right + k right_stride on. It stays in registers until it is done.
inline Tile tile_product(const double* left, Eigen::Index left_stride, const double* right,
                         Eigen::Index right_stride, Eigen::Index count) {
  using Column = Eigen::Array<double, tile_rows, 1>;
  Tile tile = Tile::Zero();
  for (Eigen::Index k = 0; k < count; ++k, left += left_stride, right += right_stride) {
    const Column u = Eigen::Map<const Column>(left);
    for (int j = 0; j < tile_rows; ++j) {
      tile.col(j) += u * right[j];
    }
  }
  return tile;
}

}  // namespace hagfish
