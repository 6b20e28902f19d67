// The skin that a knot has swept: what came to touch the body itself while the knot was tied. It is
// what a hagfish wipes clean of slime.
#pragma once

#include <Eigen/Core>

#include "core/log/reading/log_contents.hpp"

namespace hagfish {

/// By cells, sides x stations: stations are equal parts of the length, two for each body, sides are
/// equal parts of the way round, from the body's Y axis over its Z axis.
struct SweptSkin {
  Eigen::MatrixXd area;   ///< of skin, cm^2
  Eigen::MatrixXd since;  ///< when it was first touched, s; nan where it never was
  double all() const { return area.sum(); }                                     ///< cm^2
  double swept() const { return since.array().isNaN().select(0, area).sum(); }  ///< cm^2
};

/// Of the contacts with a force that a log has from tightening to release. One sweeps the cells
/// that lie as near to it as skins of round strands which cross there are no further apart than
/// controller.contact_gap.
SweptSkin swept_skin(const LogContents& log);

}  // namespace hagfish
