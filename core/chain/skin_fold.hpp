// Whether the skin folds into itself inside of a bend. No contact row sees that: parts of the body
// with less than contact.least_arc between them never touch.
#pragma once

#include "core/chain/kinematics.hpp"

namespace hagfish {

/// Radius of the skin over radius of curvature, the largest along the body. Above 1 the skin inside
/// of a bend folds into itself. The radius of curvature is taken across one local diameter d: d
/// over the turn of the body's X axis along it (rad). The X axis turns evenly from half way between
/// two bending joints to half way between the next two. So the mesh hardly matters, and a sharper
/// bend of less than a diameter counts by its mean. 0 for a body shorter than a diameter.
double skin_fold(const Model& model, const Kinematics& kin);

}  // namespace hagfish
