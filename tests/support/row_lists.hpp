// Constraint rows of one kind as a list of their own; core appends them to a step's list.
#pragma once

#include <limits>
#include <vector>

#include "core/step/rows/contact_rows.hpp"
#include "core/step/rows/eq6_rows.hpp"
#include "core/step/rows/joint_rows.hpp"

namespace hagfish {

inline std::vector<Row> head_rows(const State& state, const ConstraintSettings& settings,
                                  double h) {
  std::vector<Row> rows;
  append_head_rows(state, settings, h, rows);
  return rows;
}

/// Where all rows are wanted, whatever the velocity.
struct AllRows {
  explicit AllRows(const Model& model)
      : v(Eigen::VectorXd::Zero(model.nv())),
        twist(Matrix6Xd::Zero(6, model.body_count())),
        centre_velocity(Eigen::Matrix3Xd::Zero(3, model.body_count())) {}
  Eigen::VectorXd v;
  Matrix6Xd twist;
  Eigen::Matrix3Xd centre_velocity;
  NearBinding wanted{v, {twist, centre_velocity}, std::numeric_limits<double>::infinity(), 0};
};

inline std::vector<Row> limit_rows(const Model& model, const State& state,
                                   const ConstraintSettings& settings, double h) {
  std::vector<Row> rows;
  append_limit_rows(model, state, settings, h, AllRows(model).wanted, rows);
  return rows;
}

inline std::vector<Row> contact_rows(const Model& model, const ContactSet& contacts,
                                     const ConstraintSettings& settings, double h) {
  std::vector<Row> rows;
  const AllRows all(model);
  for (const auto* list : {&contacts.contacts, &contacts.on_obstacles, &contacts.near_pairs}) {
    for (const Contact& contact : *list) {
      append_contact_row(model, contact, nullptr, settings, h, all.wanted, rows);
    }
  }
  return rows;
}

inline std::vector<Row> plane_rows(const Model& model, const Kinematics& kin,
                                   const ConstraintSettings& settings, double h) {
  std::vector<Row> rows;
  append_plane_rows(model, kin, settings, h, AllRows(model).wanted, rows);
  return rows;
}

inline std::vector<Row> thigmotaxis_rows(const Model& model,
                                         const std::vector<ThigmotaxisCommand>& commands,
                                         const ControllerSettings& settings, const Kinematics& kin,
                                         double h) {
  std::vector<Row> rows;
  const std::vector<SplineSegment> segments = spline(model, kin.centre);
  Scene scene;
  scene.controller = settings;
  append_thigmotaxis_rows(model, commands, {kin, segments, false}, scene, h, rows);
  return rows;
}

}  // namespace hagfish
