#include "core/knot/colouring.hpp"

#include <algorithm>

namespace hagfish {

WholeMatrix colouring_minor(const Diagram& diagram, std::int64_t t) {
  const int size = static_cast<int>(diagram.passages.size()) / 2 - 1;
  std::vector<int> arc_over(diagram.sign.size());
  int arc = 0;
  for (const Passage& passage : diagram.passages) {
    if (passage.over) {
      arc_over[passage.crossing] = arc % (size + 1);
    } else {
      ++arc;
    }
  }
  std::vector<std::int64_t> entries(static_cast<std::size_t>(size) * size, 0);
  int row = 0;
  const auto add = [&](int column, std::int64_t value) {
    if (column < size) entries[row * size + column] += value;
  };
  for (const Passage& passage : diagram.passages) {
    if (passage.over) continue;
    if (row == size) break;
    const bool positive = diagram.sign[passage.crossing] > 0;
    add(arc_over[passage.crossing], 1 - t);
    add(positive ? row : row + 1, t);
    add(positive ? row + 1 : row, -1);
    ++row;
  }
  return {size, std::move(entries)};
}

std::int64_t inverse_modulo(std::int64_t value, std::int64_t prime) {
  std::int64_t result = 1;  // value^(prime - 2), by Fermat
  for (std::int64_t power = prime - 2; power > 0; power /= 2) {
    if (power % 2 == 1) result = result * value % prime;
    value = value * value % prime;
  }
  return result;
}

std::int64_t determinant_modulo(WholeMatrix matrix, std::int64_t prime) {
  const int size = matrix.size;
  for (std::int64_t& entry : matrix.entries) entry = (entry + prime) % prime;
  std::int64_t determinant = 1;
  for (int k = 0; k < size; ++k) {
    const auto row = [&](int i) { return matrix.entries.begin() + i * size; };
    int pivot = k;
    while (pivot < size && row(pivot)[k] == 0) ++pivot;
    if (pivot == size) return 0;
    if (pivot != k) {
      std::swap_ranges(row(pivot), row(pivot) + size, row(k));
      determinant = prime - determinant;
    }
    determinant = determinant * row(k)[k] % prime;
    const std::int64_t inverse = inverse_modulo(row(k)[k], prime);
    for (int i = pivot + 1; i < size; ++i) {
      if (row(i)[k] == 0) continue;
      const std::int64_t factor = prime - row(i)[k] * inverse % prime;
      for (int j = k; j < size; ++j) row(i)[j] = (row(i)[j] + factor * row(k)[j]) % prime;
    }
  }
  return determinant > prime / 2 ? determinant - prime : determinant;
}

}  // namespace hagfish
