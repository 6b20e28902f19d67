// Rows of contact (Eq. 4): of the body with itself, with strands and with planes.
#pragma once

#include <vector>

#include "core/contact/obstacles.hpp"
#include "core/step/rows/unilateral.hpp"

namespace hagfish {

/// The relative motion along `direction` of the two spline points of a contact. An obstacle is at
/// rest.
BetweenPoints between_points(const Contact& contact, const Eigen::Vector3d& direction,
                             const Model& model);

/// The Row::id of the contact's row.
RowId contact_row_id(const Contact& contact);

/// The row of a contact without a right-hand side: the exact rate of its gap. Where `at` is null,
/// the points are where the contact was found. Else they are the same points of the segments `at`.
/// `number` is 0 for the row of the step's start, and counts the rows that are added later
/// (look_ahead.hpp).
Row contact_row(const Model& model, const Contact& contact, const std::vector<SplineSegment>* at,
                int number = 0);
/// The row of a body against a plane, without a right-hand side.
Row plane_row(const PlaneGap& gap);

/// The row of a contact at `at`: the exact rate of its gap.
void append_contact_row(const Model& model, const Contact& contact,
                        const std::vector<SplineSegment>* at, const ConstraintSettings& settings,
                        double h, const NearBinding& wanted, std::vector<Row>& rows);

/// One row for each body and each plane that holds it.
void append_plane_rows(const Model& model, const Kinematics& kin,
                       const ConstraintSettings& settings, double h, const NearBinding& wanted,
                       std::vector<Row>& rows);

}  // namespace hagfish
