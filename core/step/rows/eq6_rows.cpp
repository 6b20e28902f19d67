#include "core/step/rows/eq6_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/step/rows/contact_rows.hpp"

namespace hagfish {
namespace {

/// The sum of rows with points, by body.
class WrenchSum {
 public:
  explicit WrenchSum(int bodies)
      : wrench_(Matrix6Xd::Zero(6, bodies)), loaded_(static_cast<std::size_t>(bodies)) {}

  void add(const Row& row, const Kinematics& kin, double share) {
    visit_forces(row, kin,
                 [&](int body, const Eigen::Vector3d& moment, const Eigen::Vector3d& force) {
                   wrench_.col(body).head<3>() += share * moment;
                   wrench_.col(body).tail<3>() += share * force;
                   loaded_[static_cast<std::size_t>(body)] = 1;
                 });
  }

  /// Of the bodies that take part, rising.
  std::vector<BodyWrench> of_bodies() const {
    std::vector<BodyWrench> found;
    found.reserve(static_cast<std::size_t>(std::ranges::count(loaded_, 1)));
    for (int body = 0; body < static_cast<int>(wrench_.cols()); ++body) {
      if (loaded_[static_cast<std::size_t>(body)] == 0) continue;
      found.push_back({body, wrench_.col(body).head<3>(), wrench_.col(body).tail<3>()});
    }
    return found;
  }

 private:
  Matrix6Xd wrench_;
  std::vector<char> loaded_;
};

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
  contact_patch(segments, scene, command.contact, tail, storage);
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
    WrenchSum sum_a(model.body_count()), sum_b(model.body_count());
    cosine = 0;
    for (const auto& [contact, share] : patch) {
      sum_a.add(along(contact, true), kin, share);
      sum_b.add(along(contact, false), kin, share);
      cosine += share * cosine_of(contact);
    }
    rows[0].shape = OverPatch{rows[0].points(), sum_a.of_bodies()};
    rows[1].shape = OverPatch{rows[1].points(), sum_b.of_bodies()};
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
