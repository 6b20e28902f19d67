// Pairs of segments whose bounding spheres are near each other (paper, 3.1), by a hierarchy of two
// levels: spheres of segments, and spheres of blocks of segments that follow each other.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/contact/spline.hpp"

namespace hagfish {

/// Two segments, a before b.
struct SegmentPair {
  int a = 0, b = 0;
};

struct NearPair {
  SegmentPair of;
  double apart = 0;  ///< distance of the spheres' centres, cm
};

/// Which pairs are near each other where the segments are now.
class BroadPhase {
 public:
  /// The pairs whose spheres are at most `reach` (cm) apart, and which have at least `least_arc`
  /// (cm) of body between them, in rising order. Valid until the next call.
  const std::vector<NearPair>& find(const std::vector<SplineSegment>& segments, double reach,
                                    double least_arc);

 private:
  /// A sphere around those of a block's segments.
  struct Block {
    Eigen::Vector3d centre;
    double bound = 0;
  };
  void gather(const std::vector<SplineSegment>& segments);
  void list_near_blocks(int block, double reach);
  void list_partners(int a, int first, double reach);

  Eigen::ArrayX3d middle_;  ///< of the segments' spheres, cm; infinite behind the last segment
  Eigen::ArrayXd bound_;    ///< of them, cm
  std::vector<Block> blocks_;
  std::vector<int> near_;  ///< blocks near the one whose segments are looked at, from it on
  std::vector<NearPair> pairs_;
};

}  // namespace hagfish
