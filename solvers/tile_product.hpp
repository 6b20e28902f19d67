// The inner loop of small dense products.
#pragma once

#include <Eigen/Core>

namespace hagfish {

/// Rows of a tile: doubles that fill a vector register.
inline constexpr Eigen::Index tile_rows = 8;

/// Σ_k u_k v_k' over k < count, with u_k the `tile_rows` entries from left + k left_stride on and
/// v_k the `columns` entries from right + k right_stride on. It stays in registers until it is
/// done.
template <int columns>
Eigen::Array<double, tile_rows, columns> tile_product(const double* left, Eigen::Index left_stride,
                                                      const double* right,
                                                      Eigen::Index right_stride,
                                                      Eigen::Index count) {
  using Column = Eigen::Array<double, tile_rows, 1>;
  Eigen::Array<double, tile_rows, columns> tile = Eigen::Array<double, tile_rows, columns>::Zero();
  for (Eigen::Index k = 0; k < count; ++k, left += left_stride, right += right_stride) {
    const Column u = Eigen::Map<const Column>(left);
    for (int j = 0; j < columns; ++j) {
      tile.col(j) += u * right[j];
    }
  }
  return tile;
}

}  // namespace hagfish
