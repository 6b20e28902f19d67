#include "core/contact/broad_phase.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/chain/lanes.hpp"

namespace hagfish {
namespace {

/// Segments of a block: whole vector registers of them. Affects speed only.
constexpr int block_size = 8;
static_assert(block_size % lane_count == 0);

/// Of a block's sphere, so that rounding leaves out no segment.
constexpr double slack = 1e-9;

}  // namespace

const std::vector<NearPair>& BroadPhase::find(const std::vector<SplineSegment>& segments,
                                              double reach, double least_arc) {
  pairs_.clear();
  gather(segments);
  const int n = static_cast<int>(segments.size());
  int first = 0;  // partner of segment a: along the body as a is
  for (int a = 0; a < n; ++a) {
    const double end = segments[a].arc(1);
    first = std::max(first, a + 1);
    while (first < n && segments[first].s0 - end < least_arc) ++first;
    if (first == n) {
      break;
    }
    if (a % block_size == 0) list_near_blocks(a / block_size, reach);
    list_partners(a, first, reach);
  }
  return pairs_;
}

void BroadPhase::gather(const std::vector<SplineSegment>& segments) {
  const int n = static_cast<int>(segments.size());
  const int blocks = (n + block_size - 1) / block_size;
  middle_.resize(blocks * block_size, 3);
  // Near to nothing, whatever its size: infinity would be near to what overflows.
  middle_.bottomRows(blocks * block_size - n) = std::numeric_limits<double>::quiet_NaN();
  bound_.setZero(blocks * block_size);
  blocks_.resize(blocks);
  for (int k = 0; k < blocks; ++k) {
    const int begin = k * block_size;
    const int end = std::min(n, begin + block_size);
    Block& block = blocks_[k];
    block.centre.setZero();
    for (int i = begin; i < end; ++i) {
      middle_.row(i) = segments[i].middle.transpose();
      bound_[i] = segments[i].bound;
      block.centre += segments[i].middle / (end - begin);
    }
    block.bound = 0;
    for (int i = begin; i < end; ++i) {
      block.bound =
          std::max(block.bound, (segments[i].middle - block.centre).norm() + segments[i].bound);
    }
  }
}

void BroadPhase::list_near_blocks(int block, double reach) {
  near_.clear();
  const Block& own = blocks_[block];
  for (int k = block; k < static_cast<int>(blocks_.size()); ++k) {
    const double most = (own.bound + blocks_[k].bound + reach) * (1 + slack);
    if ((own.centre - blocks_[k].centre).squaredNorm() <= most * most) near_.push_back(k);
  }
}

/// Lists the partners of segment `a` from `first` on.
void BroadPhase::list_partners(int a, int first, double reach) {
  const Lanes x = lanes_of(middle_(a, 0));
  const Lanes y = lanes_of(middle_(a, 1));
  const Lanes z = lanes_of(middle_(a, 2));
  const Lanes own = lanes_of(bound_[a] + reach);
  for (const int block : near_) {
    const int end = (block + 1) * block_size;
    for (int b = std::max(block * block_size, first / lane_count * lane_count); b < end;
         b += lane_count) {
      const Lanes dx = lanes_at(&middle_(b, 0)) - x;
      const Lanes dy = lanes_at(&middle_(b, 1)) - y;
      const Lanes dz = lanes_at(&middle_(b, 2)) - z;
      const Lanes square = dx * dx + dy * dy + dz * dz;
      const Lanes most = own + lanes_at(&bound_[b]);
      unsigned bits = bits_of(square <= most * most);
      if (b < first) bits &= ~0U << (first - b);
      for (; bits != 0; bits &= bits - 1) {
        const int lane = std::countr_zero(bits);
        pairs_.push_back({{a, b + lane}, std::sqrt(square[lane])});
      }
    }
  }
}

}  // namespace hagfish
