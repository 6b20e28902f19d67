#include <cmath>
#include <utility>

#include "core/chain/bending.hpp"
#include "core/knot/knot.hpp"
#include "core/knot/writhe.hpp"
#include "experiments/export/export_tables.hpp"
#include "experiments/export/frame_contacts.hpp"
#include "experiments/judge/replay.hpp"

namespace hagfish {
namespace {

using namespace figure_unit;

ExportTable midline_table(bool si) {
  return {"midline.csv",
          {frame_column,
           time_column,
           {"point", none,
            "0 the head's end, 1 to N the middles of the N bodies, N + 1 the tail's end"},
           {"s", centimetre, "arc length from the head's end at rest"},
           {"x", centimetre,
            "place, world axes: the run starts with the head at 0 and the straight body along +x"},
           {"y", centimetre, "place"},
           {"z", centimetre, "place"},
           {"radius", centimetre, "of the skin"}},
          si};
}

void add_midline(const LogContents& log, const ShownFrame& frame, ExportTable& table) {
  const Kinematics& kin = frame.observation.kin;
  const std::vector<Body>& bodies = log.model.bodies;
  const std::size_t count = bodies.size();
  const auto add = [&](std::size_t point, double s, const Eigen::Vector3d& x, double radius) {
    table.add({std::int64_t{frame.index}, log.time[frame.index], static_cast<std::int64_t>(point),
               s, x.x(), x.y(), x.z(), radius});
  };
  add(0, 0, kin.origin.col(0), bodies.front().radius);
  double s = 0;
  for (std::size_t b = 0; b < count; ++b) {
    add(b + 1, s + 0.5 * bodies[b].length, kin.centre.col(static_cast<Eigen::Index>(b)),
        bodies[b].radius);
    s += bodies[b].length;
  }
  const auto last = static_cast<Eigen::Index>(count) - 1;
  add(count + 1, s, 2 * kin.centre.col(last) - kin.origin.col(last), bodies.back().radius);
}

ExportTable curvature_table(bool si) {
  return {"curvature.csv",
          {frame_column,
           time_column,
           {"joint", none, "a joint that bends, by the body behind it"},
           {"s", centimetre, "arc length from the head's end at rest"},
           {"bend_y", per_length,
            "turn about the body's Y axis, over the length of body that the joint stands for"},
           {"bend_z", per_length, "the same about its Z axis"},
           {"curvature", per_length, "total bend of both, over the same length"},
           {"twist", per_length,
            "turn of the twisting joints on both sides, over the length that they stand for"}},
          si};
}

void add_curvature(const LogContents& log, const ShownFrame& frame, ExportTable& table) {
  const Model& model = log.model;
  const int n = model.body_count();
  const double length = model.length() / n;
  for (int b = 1; b < n; ++b) {
    const Body& body = model.bodies[b];
    if (body.dofs != 2) continue;
    double y = frame.q[body.first_dof + 1];
    double z = frame.q[body.first_dof + 2];
    if (model.hinges[body.first_dof - root_dofs].axis == Axis::z) std::swap(y, z);
    const double span = hinge_span(model, b);
    double turn = 0, along = 0;
    for (const int beside : {b - 1, b + 1}) {
      if (beside < 1 || beside >= n || model.bodies[beside].dofs != 1) continue;
      turn += frame.q[model.bodies[beside].first_dof + 1];
      along += hinge_span(model, beside);
    }
    table.add({std::int64_t{frame.index}, log.time[frame.index], std::int64_t{b}, b * length,
               y / span, z / span, total_bend(y, z).angle / span, along > 0 ? turn / along : NAN});
  }
}

ExportTable knot_table(bool si) {
  return {"knot.csv",
          {frame_column,
           time_column,
           {"phase", none, "form, tighten, slide, pull, reverse, release, free"},
           {"knot", none, "knot type of the centreline; 0_1 is no knot"},
           {"determinant", none, "knot determinant"},
           {"v2", none, "Vassiliev invariant of order 2"},
           {"agreement", none, "share of the projections that agree on the type"},
           {"writhe", none, "of the open centreline: above 0 right-handed, below left-handed"},
           {"head_end", centimetre, "arc length from the head of the first contact"},
           {"tail_end", centimetre, "arc length from the head of the last contact"},
           {"span", centimetre, "length of body between them"}},
          si};
}

ExportTable contact_table_of(bool si) {
  return {"contacts.csv",
          {frame_column,
           time_column,
           {"kind", none,
            "self: two strands of the body; plate: the body and the head plate; else the name of "
            "the obstacle"},
           {"s_a", centimetre, "arc length of the point on the strand nearer the head"},
           {"s_b", centimetre, "arc length of the point on the strand nearer the tail"},
           {"gap", centimetre, "between the skins; below 0 they overlap"},
           {"x", centimetre, "place of the contact, in the middle of the gap"},
           {"y", centimetre, "place"},
           {"z", centimetre, "place"},
           {"normal_x", none, "unit vector along which strand a is pushed"},
           {"normal_y", none, "unit vector"},
           {"normal_z", none, "unit vector"},
           {"force", force,
            "along the normal, of the step at the frame; 0 where the skins are near but do not "
            "press"}},
          si};
}

std::string kind_of(const LogContents& log, int obstacle) {
  if (obstacle < 0) return "self";
  const bool plate = log.resolved.scene.wall.present && obstacle == 0;
  return plate ? "plate" : log.model.obstacles[static_cast<std::size_t>(obstacle)].name;
}

void add_contacts(const LogContents& log, const FrameContacts& contacts, const ShownFrame& frame,
                  ExportTable& table) {
  for (const FrameContact& c : contacts.at(frame)) {
    table.add({std::int64_t{frame.index}, log.time[frame.index], kind_of(log, c.obstacle), c.arc_a,
               c.arc_b, c.gap, c.point.x(), c.point.y(), c.point.z(), c.normal.x(), c.normal.y(),
               c.normal.z(), c.force});
  }
}

}  // namespace

std::vector<ExportTable> shape_tables(const LogContents& log, bool si) {
  ExportTable midline = midline_table(si), curvature = curvature_table(si), knot = knot_table(si),
              contacts = contact_table_of(si);
  const FrameContacts of_frame(log);
  const std::vector<KnotInvariants> types = logged_knots(log);
  const std::vector<double> agreement = log.h5.doubles("/knot/agreement");
  const std::vector<double> head_end = log.h5.doubles("/knot/head_end");
  const std::vector<double> tail_end = log.h5.doubles("/knot/tail_end");
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    const ShownFrame frame(log, static_cast<Eigen::Index>(f));
    add_midline(log, frame, midline);
    add_curvature(log, frame, curvature);
    const auto& [determinant, v2] = types[f];
    knot.add({static_cast<std::int64_t>(f), log.time[f], std::string(phase_name(frame.phase)),
              knot_name(types[f]), std::int64_t{determinant}, std::int64_t{v2}, agreement[f],
              writhe(frame.observation.kin.centre), head_end[f], tail_end[f],
              tail_end[f] - head_end[f]});
    add_contacts(log, of_frame, frame, contacts);
  }
  return {midline, curvature, knot, contacts};
}

}  // namespace hagfish
