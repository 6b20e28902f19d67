// The contacts with a force that a log holds: of the body with itself, and with obstacles.
#pragma once

#include <vector>

#include "core/contact/contact.hpp"
#include "experiments/audit/audited_frame.hpp"

namespace hagfish {

struct LoggedContact {
  std::int64_t frame = 0;
  double a = 0;            ///< spline parameter; of a plane the body
  double b = 0;            ///< spline parameter on the body; nan on an obstacle
  int obstacle = -1;       ///< index in Model::obstacles; -1 where it is the body itself
  double on_obstacle = 0;  ///< spline parameter on the strand that is an obstacle, else nan
  double force = 0;        ///< dyn
};

/// Those of a log, frame by frame. Without obstacles in its scene all but those of the body with
/// itself are the head plate's.
std::vector<LoggedContact> logged_contacts(const LogContents& log);

/// Whether the contact lies on the animal and on what it says that it is with.
bool is_placed(const Model& model, const LoggedContact& contact);

/// The contact where it lies, which must be so, on `segments` (update_segments()) of bodies placed
/// as `kin`. Of a plane, tangent_b and the place on b are not set.
Contact placed_contact(const Model& model, const Kinematics& kin,
                       const std::vector<SplineSegment>& segments, const LoggedContact& logged);

}  // namespace hagfish
