// Rows rebuilt from what a log says of them: spline parameters and a direction.
#pragma once

#include "core/step/rows/row.hpp"
#include "experiments/audit/audited_frame.hpp"
#include "experiments/audit/logged_contacts.hpp"

namespace hagfish {

/// Relative motion of two spline points along `direction`, by their spline parameters; where the
/// second one is nan, of the first alone.
Row motion_row(const Model& model, const Eigen::Vector3d& direction, double a, double b);

/// The contact of two spline points, by their parameters, on `segments`.
Contact contact_of(const Model& model, const std::vector<SplineSegment>& segments, double a,
                   double b);

/// The direction in which a logged contact pushes in the step at a frame (flesh_rows.hpp).
Eigen::Vector3d push_of(const LogContents& log, const AuditedFrame& frame,
                        const LoggedContact& contact);

/// C' λ of one row, generalised (nv).
Eigen::VectorXd force_of(const Model& model, const Kinematics& kin, const Row& row, double lambda);

}  // namespace hagfish
