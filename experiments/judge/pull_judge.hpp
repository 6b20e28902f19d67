// The pull at food: how large and steady it is, what it rests on and when it ends.
#pragma once

#include <vector>

#include "experiments/judge/expectations.hpp"
#include "experiments/judge/run_frame.hpp"

namespace hagfish {

class PullJudge {
 public:
  /// The scene is referred to.
  explicit PullJudge(const Scene& scene) : scene_(scene) {}
  void see(const RunFrame& frame);
  /// Mean of the settled pull, N; nan where too few frames are of it.
  double settled() const;
  /// None where the run does not come to a pull.
  std::vector<Finding> findings() const;

 private:
  /// A frame, and means since the frame before, dyn.
  struct Means {
    double time = 0;  ///< s
    bool pulls = false;
    double force = 0;  ///< pull of the head at the food
    double plate = 0;  ///< force of the head plate
    double water = 0;  ///< drag along x
  };
  /// Frames of the pull whose frame before is of it too: all steps between them are.
  std::vector<std::size_t> intervals() const;
  std::vector<Means> settled_part() const;
  static std::vector<Criterion> criteria(const ExpectSettings& expect,
                                         const std::vector<Means>& settled);
  std::vector<Finding> of_settled() const;
  Finding end(const std::vector<std::size_t>& pull) const;

  const Scene& scene_;
  std::vector<Means> frames_;
  double drag_before_ = 0;
};

}  // namespace hagfish
