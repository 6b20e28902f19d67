// The head plate: the half space x < 0, which bodies behind the neck stay out of.
#pragma once

#include "core/chain/kinematics.hpp"
#include "core/chain/model.hpp"
#include "core/scene/settings.hpp"

namespace hagfish {

/// Calls `visit(body, gap)` for each body behind the neck with its gap to the plate x = 0, cm,
/// negative where its skin is in the plate. `kin` needs positions only.
template <class Visit>
void visit_wall_gaps(const Model& model, const Kinematics& kin, const WallSettings& wall,
                     Visit visit) {
  double arc = 0;
  for (int b = 0; wall.present && b < model.body_count(); ++b) {
    const Body& body = model.bodies[b];
    arc += body.length;
    if (arc - 0.5 * body.length >= wall.neck) {
      visit(b, kin.centre(0, b) - body.radius);
    }
  }
}

}  // namespace hagfish
