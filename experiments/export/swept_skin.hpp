// The skin that a knot has swept: what came to touch the body itself while the knot was tied. It is
// what a hagfish wipes clean of slime.
#pragma once

#include <Eigen/Core>

#include "core/log/reading/log_contents.hpp"

namespace hagfish {

/// Cells of skin, sides x stations. Stations are equal parts of the length, two for each body.
/// Sides are equal parts of the way round, from the body's Y axis over its Z axis.
struct SweptSkin {
  Eigen::MatrixXd area;   ///< area of skin, cm^2
  Eigen::MatrixXd since;  ///< time of the first touch, s; nan where there was none
  double all() const { return area.sum(); }                                     ///< cm^2
  double swept() const { return since.array().isNaN().select(0, area).sum(); }  ///< cm^2
};

/// Skin swept by the contacts with a force that a log has from tightening to release. One sweeps
/// the cells that lie as near to it as skins of round strands which cross there are no further
/// apart than controller.contact_gap.
SweptSkin swept_skin(const LogContents& log);

}  // namespace hagfish
