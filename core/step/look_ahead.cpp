#include "core/step/look_ahead.hpp"

#include <algorithm>
#include <cmath>

#include "core/contact/obstacles.hpp"
#include "core/step/rows/contact_rows.hpp"
#include "core/step/rows/joint_rows.hpp"

namespace hagfish {
namespace {

/// The number of rows that the path has given the contact with this id in this step.
int rows_of_contact(const RowId& id, const StepSolution& step) {
  return static_cast<int>(std::ranges::count_if(step.path_rows, [&](const PathRow& path_row) {
    return path_row.contact && contact_row_id(*path_row.contact) == id;
  }));
}

}  // namespace

int path_samples(const Eigen::Matrix3Xd& centre_velocity, const Eigen::Vector3d& observer, double h,
                 double stride) {
  const double longest =
      h * std::sqrt((centre_velocity.colwise() - observer).colwise().squaredNorm().maxCoeff());
  return std::max(1, static_cast<int>(std::ceil(longest / stride)));
}

std::vector<PathRow> missed_rows(const StepInput& in, const StepPlace& place,
                                 const Observation& there, double t, const StepSolution& step) {
  std::vector<PathRow> missed;
  if (in.scene.flesh.present()) return missed;
  const ConstraintSettings& settings = in.scene.constraints;
  const Observation& now = in.observation;
  const double h = in.scene.time.step;
  // On the path strands must only not pass through each other. The end is the start of the next
  // step.
  const double tolerance = t < h ? way_tolerance * settings.stride : settings.tolerance;
  const auto check = [&](double gap_now, double gap_there, const auto& make_row) {
    const double before = std::min(0.0, gap_now);
    const double goal =
        before + std::min(-settings.baumgarte * before, h * settings.baumgarte_speed);
    if (gap_there < goal - tolerance) {
      Row& row = missed.emplace_back(make_row()).row;
      const double error = gap_there - gap_now - t * row_velocity(row, step.bodies(), step.qdot);
      // At great speeds the error of the linear row grows without bound. Rows that ask strands to
      // part by more than they may move between samples only contradict each other.
      row.rhs = std::min(goal - gap_now - error * (h / t) * (h / t), settings.stride) / h;
    }
  };
  const ContactSet& found = there.contact;
  for (const auto* contacts : {&found.contacts, &found.on_obstacles, &found.near_pairs}) {
    for (const Contact& contact : *contacts) {
      if (contact.gap < -tolerance) {
        const Contact before = contact_at(now.segments, contact.segment_a, contact.t_a,
                                          contact.segment_b, contact.t_b);
        check(before.gap, contact.gap, [&] {
          return PathRow{contact_row(in.model, before, place.segments,
                                     rows_of_contact(contact_row_id(before), step)),
                         before};
        });
      }
    }
  }
  visit_plane_gaps(in.model, there.kin, [&](const PlaneGap& at) {
    check(plane_gap(in.model, now.kin, at.plane, at.body), at.gap, [&] {
      return PathRow{plane_row(at), {}};
    });
  });
  return missed;
}

std::vector<PathRow> missed_bends(const StepInput& in, const Eigen::VectorXd& there,
                                  const StepSolution& step) {
  const Eigen::VectorXd& now = in.state.q;
  std::vector<PathRow> missed;
  for (const BendingCone& cone : in.model.cones) {
    const double left = (1 - in.scene.constraints.baumgarte) * past_cone(cone, now);
    if (past_cone(cone, there) <= left + bend_tolerance) continue;
    const Eigen::Vector2d goal =
        bend_to(there[cone.dof + 1], there[cone.dof + 2], cone.limit + left);
    int tangents = 1;
    while (std::ranges::find(step.rows, cone_row(cone, {}, tangents).id, &Row::id) !=
           step.rows.end()) {
      ++tangents;
    }
    Row row = cone_row(cone, total_bend(goal[0], goal[1]), tangents);
    const Eigen::Vector2d way = goal - now.segment<2>(cone.dof + 1);
    row.rhs = (row.joint()->sign * way[0] + row.joint()->next_sign * way[1]) / in.scene.time.step;
    missed.push_back({row, {}});
  }
  return missed;
}

}  // namespace hagfish
