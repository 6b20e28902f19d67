#include "core/step/look_ahead.hpp"

#include <algorithm>
#include <cmath>

namespace hagfish {
namespace {

auto known(std::int64_t id, std::vector<Row>& rows) {
  return std::ranges::find(rows, id, &Row::id);
}

/// A row's place is kept where it has one: what is known of its multiplier stays by it.
void put(const Row& row, std::vector<Row>& rows) {
  const auto place = known(row.id, rows);
  if (place == rows.end()) {
    rows.push_back(row);
  } else {
    *place = row;
  }
}

}  // namespace

int path_samples(const Eigen::Matrix3Xd& centre_velocity, double h, double stride) {
  const double longest = h * std::sqrt(centre_velocity.colwise().squaredNorm().maxCoeff());
  return std::max(1, static_cast<int>(std::ceil(longest / stride)));
}

bool add_missed_rows(const Model& model, const Observation& now, const Observation& there, double t,
                     const Scene& scene, const StepSolution& step, std::vector<Row>& rows) {
  const ConstraintSettings& settings = scene.constraints;
  const double h = scene.time.step;
  // On the way strands must not pass through each other; its end is the next step's start.
  const double tolerance = t < h ? way_tolerance * settings.stride : settings.tolerance;
  bool any = false;
  const auto look = [&](double gap_now, double gap_there, const auto& make_row) {
    const double before = std::min(0.0, gap_now);
    const double goal =
        before + std::min(-settings.baumgarte * before, h * settings.baumgarte_speed);
    if (gap_there < goal - tolerance) {
      Row row = make_row();
      const double missed =
          gap_there - gap_now - t * row_velocity(row, step.centre_velocity, step.qdot);
      // At great speeds what the line misses grows beyond all sense; rows that ask strands to part
      // by more than they may move unseen only contradict each other.
      row.rhs = std::min(goal - gap_now - missed * (h / t) * (h / t), settings.stride) / h;
      put(row, rows);
      any = true;
    }
  };
  for (const auto* contacts : {&there.contact.contacts, &there.contact.others}) {
    for (const Contact& contact : *contacts) {
      if (contact.gap < -tolerance) {
        const Contact before = contact_at(now.segments, contact.segment_a, contact.t_a,
                                          contact.segment_b, contact.t_b);
        look(before.gap, contact.gap, [&] { return contact_row(model, before); });
      }
    }
  }
  visit_wall_gaps(model, there.kin, scene.wall, [&](int body, double gap) {
    look(now.kin.centre(0, body) - model.bodies[body].radius, gap, [&] { return wall_row(body); });
  });
  return any;
}

bool add_missed_bends(const Model& model, const Eigen::VectorXd& now, const Eigen::VectorXd& there,
                      const Scene& scene, std::vector<Row>& rows) {
  bool any = false;
  for (const BendingCone& cone : model.cones) {
    const double left = (1 - scene.constraints.baumgarte) * past_cone(cone, now);
    if (past_cone(cone, there) <= left + bend_tolerance) {
      continue;
    }
    const Eigen::Vector2d goal =
        bend_to(there[cone.dof + 1], there[cone.dof + 2], cone.limit + left);
    int cuts = 1;
    while (known(cone_row(cone, {}, cuts).id, rows) != rows.end()) {
      ++cuts;
    }
    Row row = cone_row(cone, total_bend(goal[0], goal[1]), cuts);
    const Eigen::Vector2d way = goal - now.segment<2>(cone.dof + 1);
    row.rhs = (row.sign * way[0] + row.beside * way[1]) / scene.time.step;
    rows.push_back(row);
    any = true;
  }
  return any;
}

}  // namespace hagfish
