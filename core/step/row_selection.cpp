#include "core/step/row_selection.hpp"

#include <algorithm>
#include <limits>

namespace hagfish {
namespace {

/// A row is left out at first where rest and the last step's velocity keep this much clear of it,
/// cm/s or rad/s. Only speed depends on it: rows left out are checked after the solve.
constexpr double lazy_reach = 0.03;
/// A row left out counts as violated below this, cm/s or rad/s: at h = 2 ms, 2e-11 cm or rad.
constexpr double lazy_tolerance = 1e-8;
constexpr double nowhere = -std::numeric_limits<double>::infinity();

/// The unilateral rows that are near to binding. Pairs of segments that are no minimum of the gap
/// count only where they overlap or the wanted velocity makes them.
void append_unilateral_rows(const StepInput& in, const NearBinding& wanted,
                            std::vector<Row>& rows) {
  const ConstraintSettings& settings = in.scene.constraints;
  const double h = in.scene.time.step;
  const std::vector<SplineSegment>* at = in.moved_segments();
  append_contact_rows(in.model, in.observation.contact.contacts, at, settings, h, wanted, rows);
  const NearBinding others{wanted.v, wanted.centre_velocity, std::min(wanted.slack, 0.0),
                           std::min(wanted.slack_at_rest, 0.0)};
  append_contact_rows(in.model, in.observation.contact.others, at, settings, h, others, rows);
  append_limit_rows(in.model, in.state, settings, h, wanted, rows);
  append_wall_rows(in.model, in.observation.kin, in.scene.wall, settings, h, wanted, rows);
}

}  // namespace

void gather_rows(const StepInput& in, std::vector<Row>& rows) {
  const double h = in.scene.time.step;
  const Eigen::Matrix3Xd& centre_velocity = in.observation.kin.centre_velocity;
  rows.clear();
  if (in.control.clamp_head) {
    append_head_rows(in.state, in.scene.constraints, h, rows);
  }
  append_thigmotaxis_rows(in.model, in.control.thigmotaxis, in.moved_segments(),
                          in.scene.controller, in.motion().centre_velocity, h, rows);
  append_unilateral_rows(in, {in.state.qdot, centre_velocity, lazy_reach, lazy_reach}, rows);
}

void gather_violated_rows(const StepInput& in, const StepSolution& step, std::vector<Row>& rows) {
  rows.clear();
  append_unilateral_rows(in, {step.qdot, step.centre_velocity, -lazy_tolerance, nowhere}, rows);
}

}  // namespace hagfish
