#include "core/step/rows/row_selection.hpp"

#include <algorithm>
#include <cmath>

#include "core/step/rows/contact_rows.hpp"
#include "core/step/rows/flesh_rows.hpp"
#include "core/step/rows/joint_rows.hpp"

namespace hagfish {
namespace {

/// A row is left out at first if neither rest nor the last velocity brings it nearer than this to
/// binding in a step. The unit is rad for angles, and the body's radius for points. The value
/// affects speed alone, since rows that were left out are checked after the solve.
constexpr double lazy_reach = 6e-5;
/// A row that was left out counts as violated below this in a step, in the same units.
constexpr double lazy_tolerance = 2e-11;

/// The unilateral rows near binding. Pairs of segments that are not a minimum of the gap are
/// included only if `is_considered` holds. At 400 bodies each minimum has many neighbours, and few
/// of them push.
template <class Condition>
void append_unilateral_rows(const StepInput& in, const StepPlace& place, const NearBinding& wanted,
                            Condition is_considered, std::vector<Row>& rows) {
  const ConstraintSettings& settings = in.scene.constraints;
  const double h = in.scene.time.step;
  if (in.scene.flesh.present()) {
    append_flesh_rows(in, place.segments, wanted, rows);
    append_limit_rows(in.model, in.state, settings, h, wanted, rows);
    return;
  }
  const auto append = [&](const Contact& contact) {
    append_contact_row(in.model, contact, place.segments, settings, h, wanted, rows);
  };
  std::ranges::for_each(in.observation.contact.contacts, append);
  std::ranges::for_each(in.observation.contact.on_obstacles, append);
  for (const Contact& contact : in.observation.contact.near_pairs) {
    if (is_considered(contact)) append(contact);
  }
  append_limit_rows(in.model, in.state, settings, h, wanted, rows);
  append_plane_rows(in.model, in.observation.kin, settings, h, wanted, rows);
}

}  // namespace

void gather_rows(const StepInput& in, const StepPlace& place, const WarmStart& warm,
                 std::vector<Row>& rows) {
  const double h = in.scene.time.step;
  rows.clear();
  if (in.control.clamp_head) append_head_rows(in.state, in.scene.constraints, h, rows);
  const bool displaced = place.segments != nullptr;
  append_thigmotaxis_rows(in.model, in.control.thigmotaxis,
                          {place.kin, displaced ? *place.segments : in.observation.segments,
                           displaced, displaced ? nullptr : &in.observation},
                          in.scene, h, rows);
  const auto pushed = [&](const Contact& contact) {
    return warm.find(contact_row_id(contact)) != nullptr;
  };
  append_unilateral_rows(in, place,
                         {place.velocity, place.kin.velocities(), lazy_reach / h, lazy_reach / h,
                          in.model.bodies[0].radius},
                         pushed, rows);
}

Row placed_row(const StepPlace& place, const PathRow& path_row) {
  if (!path_row.contact) return path_row.row;
  Row row = path_row.row;
  if (place.segments != nullptr) {
    std::get<BetweenPoints>(row.shape).direction =
        contact_normal(*place.segments, *path_row.contact);
  }
  return row;
}

void put_row(const Row& row, std::vector<Row>& rows) {
  const auto place = std::ranges::find(rows, row.id, &Row::id);
  if (place == rows.end()) {
    rows.push_back(row);
  } else {
    *place = row;
  }
}

void gather_violated_rows(const StepInput& in, const StepPlace& place, const StepSolution& step,
                          std::vector<Row>& rows) {
  rows.clear();
  const auto all = [](const Contact&) { return true; };
  append_unilateral_rows(in, place,
                         {step.qdot, step.bodies(), -lazy_tolerance / in.scene.time.step, -INFINITY,
                          in.model.bodies[0].radius},
                         all, rows);
}

}  // namespace hagfish
