// The contacts of a frame: those that bear, with the forces that the log has of them, and those
// that a search finds to be near without bearing.
#pragma once

#include <vector>

#include "experiments/audit/logged_contacts.hpp"

namespace hagfish {

struct FrameContact {
  int obstacle = -1;       ///< index in Model::obstacles; -1: of two strands of the body
  double arc_a = 0;        ///< arc length from the head, cm; of the strand nearer the head
  double arc_b = 0;        ///< arc length on the other one; nan of an obstacle
  double gap = 0;          ///< cm
  Eigen::Vector3d point;   ///< middle of the gap, world, cm
  Eigen::Vector3d normal;  ///< unit, world: the way that strand a is pushed
  double force = 0;        ///< force in the frame's step, dyn; 0 where it does not bear
};

/// What a log holds of its contacts, by frame.
class FrameContacts {
 public:
  /// The log is referred to. Throws FileError where a contact lies beyond the animal's ends.
  explicit FrameContacts(const LogContents& log);
  /// Contacts from head to tail by strand a, those with obstacles among them.
  std::vector<FrameContact> at(const ShownFrame& frame) const;

 private:
  const LogContents& log_;
  std::vector<std::vector<LoggedContact>> bearing_;  ///< bearing contacts of each frame
};

}  // namespace hagfish
