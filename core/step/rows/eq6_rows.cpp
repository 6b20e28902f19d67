#include "core/step/rows/eq6_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/step/rows/contact_rows.hpp"

namespace hagfish {
namespace {

/// From the point on strand b to that on strand a of a row, cm.
Eigen::Vector3d arm_of(const BetweenPoints& row, const Kinematics& kin) {
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();
  const auto add = [&](const SplineMix& mix, double sign) {
    for (int k = 0; k < mix.count; ++k) {
      arm += sign * mix.weight[k] * kin.centre_offset(mix.first + k);
    }
  };
  add(row.a, 1);
  add(row.b, -1);
  return arm;
}

double cosine_of(const Contact& contact) { return contact.tangent_a.dot(contact.tangent_b); }

/// t_a, or t_b with the sign that turns ẋ_a - ẋ_b into ẋ_b - ẋ_a; both reversed towards the tail.
Eigen::Vector3d direction_of(const Contact& contact, bool on_a, BodyEnd towards) {
  const double sense = towards == BodyEnd::head ? 1 : -1;
  return sense * (on_a ? contact.tangent_a : -contact.tangent_b);
}

bool same_points(const std::optional<Contact>& x, const Contact& y) {
  return x && x->segment_a == y.segment_a && x->t_a == y.t_a && x->segment_b == y.segment_b &&
         x->t_b == y.t_b;
}

/// Moment and force on each body of the row along t_a, then of the row along t_b.
using PatchSum = Eigen::Matrix<double, 12, Eigen::Dynamic>;

/// The rows of Eq. 6 at the points of a patch (eq6_row), each times its share. At the centreline
/// the forces of a body have one arm, and the couple at the head balances all moments.
PatchSum sum_over(const std::vector<PatchPoint>& patch, const Model& model, const Kinematics& kin,
                  const std::vector<SplineSegment>& segments, BodyEnd towards, Eq6Point at) {
  const bool at_skin = at == Eq6Point::skin;
  PatchSum sum = PatchSum::Zero(12, model.body_count());
  for (const auto& [contact, share] : patch) {
    const Eigen::Vector3d a = share * direction_of(contact, true, towards);
    const Eigen::Vector3d b = share * direction_of(contact, false, towards);
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    if (at_skin) place = skin_point(segments, contact) - kin.reference;
    Eigen::Matrix<double, 12, 1> point;
    point << place.cross(a), a, place.cross(b), b;
    const auto add = [&](int segment, double t, double sign) {
      const SplineMix mix = spline_mix(segment, t, model.body_count());
      for (int k = 0; k < mix.count; ++k) sum.col(mix.first + k) += sign * mix.weight[k] * point;
    };
    add(contact.segment_a, contact.t_a, 1);
    add(contact.segment_b, contact.t_b, -1);
  }
  if (at_skin) return sum;
  for (const int moment : {0, 6}) {
    Eigen::Vector3d total = Eigen::Vector3d::Zero();
    for (int body = 0; body < model.body_count(); ++body) {
      const Eigen::Vector3d force = sum.col(body).segment<3>(moment + 3);
      sum.col(body).segment<3>(moment) = kin.centre_offset(body).cross(force);
      total += sum.col(body).segment<3>(moment);
    }
    sum.col(0).segment<3>(moment) -= total;
  }
  return sum;
}

/// The bodies that take part in the row whose moments begin at row `moment` of `sum`, rising.
std::vector<BodyWrench> wrenches(const PatchSum& sum, int moment) {
  std::vector<BodyWrench> found;
  found.reserve(16);  // about as many as a patch loads
  for (int body = 0; body < static_cast<int>(sum.cols()); ++body) {
    if (sum.col(body).segment<6>(moment).isZero(0)) continue;
    found.push_back({body, sum.col(body).segment<3>(moment), sum.col(body).segment<3>(moment + 3)});
  }
  return found;
}

/// The patch that begins at the contact of a command: that of `found`, if it has one of this
/// contact.
const std::vector<PatchPoint>& patch_of(const std::vector<SplineSegment>& segments,
                                        const ThigmotaxisCommand& command, const Scene& scene,
                                        const Observation* found,
                                        std::vector<PatchPoint>& storage) {
  if (command.end == KnotEnd::neither) return storage;
  const bool tail = command.end == KnotEnd::last;
  if (found != nullptr) {
    const std::vector<PatchPoint>& patch = tail ? found->patches.last : found->patches.first;
    const std::optional<Contact>& end = tail ? found->ends.last : found->ends.first;
    if (!patch.empty() && same_points(end, command.contact)) return patch;
  }
  std::vector<int> near;
  contact_patch(segments, scene, command.contact, tail, near, storage);
  return storage;
}

}  // namespace

bool meets_command(double slack, double command) {
  // Relative to the commanded speed, or to 1 cm/s where that is less: Ipopt's tolerance moves the
  // speed of a row by 1e-8 of the largest in the step.
  constexpr double slack_tolerance = 1e-6;
  return slack <= slack_tolerance * std::max(1.0, std::abs(command));
}

ThigmotaxisSpeeds slip_of_shape(double cosine, const ThigmotaxisSpeeds& speed) {
  return {speed.a - speed.b * cosine, speed.b - speed.a * cosine};
}

Row eq6_row(const Model& model, const Kinematics& kin, const std::vector<SplineSegment>& segments,
            const Contact& contact, bool on_a, BodyEnd towards, Eq6Point at) {
  // Eq. 6: t_a' (ẋ_a - ẋ_b) >= v_a and t_b' (ẋ_b - ẋ_a) >= v_b.
  Row row;
  row.kind = RowKind::thigmotaxis;
  BetweenPoints points = between_points(contact, direction_of(contact, on_a, towards), model);
  if (at == Eq6Point::skin) {
    points.at = skin_point(segments, contact) - kin.reference;
  } else {
    points.head_couple = points.direction.cross(arm_of(points, kin));
  }
  row.shape = points;
  return row;
}

std::array<Row, 2> eq6_rows(const Model& model, const Kinematics& kin,
                            const std::vector<SplineSegment>& segments,
                            const ThigmotaxisCommand& command, const Scene& scene,
                            const Observation* found) {
  const auto along = [&](const Contact& contact, bool on_a) {
    return eq6_row(model, kin, segments, contact, on_a, command.towards, scene.controller.eq6_at);
  };
  std::array<Row, 2> rows = {along(command.contact, true), along(command.contact, false)};
  double cosine = cosine_of(command.contact);
  std::vector<PatchPoint> storage;
  const std::vector<PatchPoint>& patch = patch_of(segments, command, scene, found, storage);
  if (!patch.empty()) {
    const PatchSum sum =
        sum_over(patch, model, kin, segments, command.towards, scene.controller.eq6_at);
    cosine = 0;
    for (const auto& [contact, share] : patch) cosine += share * cosine_of(contact);
    rows[0].shape = OverPatch{rows[0].points(), wrenches(sum, 0)};
    rows[1].shape = OverPatch{rows[1].points(), wrenches(sum, 6)};
  }
  const ThigmotaxisSpeeds asked =
      command.slip == Eq6Slip::paper ? command.speed : slip_of_shape(cosine, command.speed);
  rows[0].rhs = asked.a;
  rows[1].rhs = asked.b;
  return rows;
}

void append_thigmotaxis_rows(const Model& model, const std::vector<ThigmotaxisCommand>& commands,
                             const ThigmotaxisPlace& place, const Scene& scene, double h,
                             std::vector<Row>& rows) {
  for (std::size_t k = 0; k < commands.size(); ++k) {
    ThigmotaxisCommand command = commands[k];
    const Contact& found = commands[k].contact;
    if (place.displaced) {
      command.contact =
          contact_at(place.segments, found.segment_a, found.t_a, found.segment_b, found.t_b);
    }
    std::array<Row, 2> pair =
        eq6_rows(model, place.kin, place.segments, command, scene, place.found);
    for (const bool on_a : {true, false}) {
      Row& row = rows.emplace_back(std::move(pair[on_a ? 0 : 1]));
      row.id = {.of = on_a ? RowId::Of::along_a : RowId::Of::along_b, .end = command.end};
      if (command.end == KnotEnd::neither) {
        row.id.first = found.segment_a;
        row.id.second = found.segment_b;
      }
      row.command = static_cast<int>(k);
      // The soft row: its L1 slack is the dual of this bound.
      row.upper = command.effort * scene.controller.cap * h;
    }
  }
}

}  // namespace hagfish
