// The part of an audit that judges the pull at food: its figures, how steady it is, what it rests
// on and when it ends.
#pragma once

#include <vector>

#include "experiments/audit/audit.hpp"
#include "experiments/audit/log_contents.hpp"

namespace hagfish {

/// Means from one frame to the next, both of the pull.
struct PullMeans {
  double time = 0;   ///< of the later frame, s
  double force = 0;  ///< of the head at the food, dyn
  double plate = 0;  ///< of the head plate, dyn
  double water = 0;  ///< of the drag along x, dyn
};

/// Whether the run comes to a pull at all.
bool pulls_at_food(const Scene& scene);
/// Whether it is a pull that settles: one that rises does not.
bool settles(const Scene& scene);
/// Those of a settled pull, past its first part.
std::vector<PullMeans> settled_part(const ExpectSettings& expect,
                                    const std::vector<PullMeans>& pull);
/// Mean, drift and balance of a settled part; none where it has too few frames to judge.
std::vector<Criterion> pull_criteria(const ExpectSettings& expect,
                                     const std::vector<PullMeans>& settled);

/// Every log's /pull; the rest where the scene has food and the run reaches it.
std::vector<Finding> audit_pull(const LogContents& log);

}  // namespace hagfish
