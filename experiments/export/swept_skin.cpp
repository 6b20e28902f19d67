#include "experiments/export/swept_skin.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "experiments/audit/logged_contacts.hpp"
#include "experiments/export/export_tables.hpp"

namespace hagfish {
namespace {

constexpr int stations_per_body = 2;
constexpr int sides = 24;
constexpr double whole_turn = 2 * std::numbers::pi;

/// Marks the cells within `reach` (cm) of the skin's point at `arc` (cm) whose outward normal is
/// `outward` (unit, world).
void sweep(const Model& model, const Kinematics& kin, double arc, const Eigen::Vector3d& outward,
           double reach, double time, SweptSkin& skin) {
  const double length = model.length();
  const auto stations = static_cast<int>(skin.area.cols());
  const auto body_at = [&](double s) {
    return std::clamp(static_cast<int>(s / length * model.body_count()), 0, model.body_count() - 1);
  };
  const Eigen::Vector3d local = kin.rotation[body_at(arc)].transpose() * outward;
  const double turn = std::atan2(local.z(), local.y());
  const double step = length / stations;
  const int first = std::max(0, static_cast<int>(std::floor((arc - reach) / step)));
  const int last = std::min(stations - 1, static_cast<int>(std::floor((arc + reach) / step)));
  for (int i = first; i <= last; ++i) {
    const double along = (i + 0.5) * step - arc;
    const double radius = model.bodies[body_at((i + 0.5) * step)].radius;
    for (int k = 0; k < sides; ++k) {
      const double apart = std::remainder((k + 0.5) / sides * whole_turn - turn, whole_turn);
      double& since = skin.since(k, i);
      if (std::isnan(since) && std::hypot(along, radius * apart) <= reach) since = time;
    }
  }
}

}  // namespace

SweptSkin swept_skin(const LogContents& log) {
  const Model& model = log.model;
  const int stations = stations_per_body * model.body_count();
  SweptSkin skin;
  skin.area.resize(sides, stations);
  for (int i = 0; i < stations; ++i) {
    const Body& body = model.bodies[i / stations_per_body];
    skin.area.col(i).setConstant(body.length / stations_per_body * whole_turn * body.radius /
                                 sides);
  }
  skin.since.setConstant(sides, stations, NAN);
  std::optional<ShownFrame> frame;
  for (const LoggedContact& one : logged_contacts(log)) {
    const auto f = static_cast<std::size_t>(one.frame);
    if (one.obstacle != -1 || !is_placed(model, one) ||
        !holds_knot(static_cast<Phase>(log.phase[f]))) {
      continue;
    }
    if (!frame || frame->index != one.frame) frame.emplace(log, one.frame);
    const Kinematics& kin = frame->observation.kin;
    const std::vector<SplineSegment>& segments = frame->observation.segments;
    const Contact contact = placed_contact(model, kin, segments, one);
    const double radius = segments[contact.segment_a].radius(contact.t_a);
    const double gap = log.resolved.scene.controller.contact_gap - std::max(0.0, contact.gap);
    const double reach = std::sqrt(2 * radius * std::max(0.0, gap));
    sweep(model, kin, contact.arc_a, -contact.normal, reach, log.time[f], skin);
    sweep(model, kin, contact.arc_b, contact.normal, reach, log.time[f], skin);
  }
  return skin;
}

ExportTable skin_table(const SweptSkin& swept, const Model& model, bool si) {
  ExportTable table(
      "skin.csv",
      {{"s", figure_unit::centimetre, "arc length from the head of the cell's middle"},
       {"side", figure_unit::radian, "way round to its middle, from the body's Y axis over its Z"},
       {"area", figure_unit::area, "of the cell"},
       {"since", figure_unit::second, "when the knot first touched it; empty where it never did"}},
      si);
  const auto stations = static_cast<double>(swept.area.cols());
  for (Eigen::Index i = 0; i < swept.area.cols(); ++i) {
    for (int k = 0; k < sides; ++k) {
      table.add({(static_cast<double>(i) + 0.5) / stations * model.length(),
                 (k + 0.5) / sides * whole_turn, swept.area(k, i), swept.since(k, i)});
    }
  }
  return table;
}

}  // namespace hagfish
