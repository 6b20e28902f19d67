#include "core/step/eq6_rows.hpp"

#include <utility>

#include "core/contact/patch.hpp"

namespace hagfish {
namespace {

/// The sum of rows with points, by body.
class WrenchSum {
 public:
  explicit WrenchSum(const Model& model)
      : wrench_(Matrix6Xd::Zero(6, model.body_count())),
        loaded_(static_cast<std::size_t>(model.body_count())) {}

  void add(const Row& row, const Kinematics& kin, double share) {
    visit_forces(row, kin,
                 [&](int body, const Eigen::Vector3d& moment, const Eigen::Vector3d& force) {
                   wrench_.col(body).head<3>() += share * moment;
                   wrench_.col(body).tail<3>() += share * force;
                   loaded_[static_cast<std::size_t>(body)] = 1;
                 });
  }

  std::vector<BodyWrench> of_bodies() const {
    std::vector<BodyWrench> found;
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

double cosine_of(const Contact& contact) { return contact.tangent_a.dot(contact.tangent_b); }

}  // namespace

ThigmotaxisSpeeds slip_of_shape(double cosine, const ThigmotaxisSpeeds& speed) {
  return {speed.a - speed.b * cosine, speed.b - speed.a * cosine};
}

Row eq6_row(const Model& model, const Kinematics& kin, const std::vector<SplineSegment>& segments,
            const Contact& contact, bool on_a, BodyEnd towards, Eq6Point at) {
  // Eq. 6: t_a' (ẋ_a - ẋ_b) >= v_a and t_b' (ẋ_b - ẋ_a) >= v_b.
  const double sense = towards == BodyEnd::head ? 1 : -1;
  Row row;
  row.kind = RowKind::thigmotaxis;
  set_points(row, contact, sense * (on_a ? contact.tangent_a : -contact.tangent_b), model);
  if (at == Eq6Point::skin) {
    row.at = skin_point(segments, contact) - kin.reference;
  }
  return row;
}

std::array<Row, 2> eq6_rows(const Model& model, const Kinematics& kin,
                            const std::vector<SplineSegment>& segments,
                            const ThigmotaxisCommand& command, const Scene& scene) {
  const auto at = [&](const Contact& contact, bool on_a) {
    return eq6_row(model, kin, segments, contact, on_a, command.towards, scene.controller.eq6_at);
  };
  std::array<Row, 2> rows{at(command.contact, true), at(command.contact, false)};
  double cosine = cosine_of(command.contact);
  std::vector<PatchPoint> patch;
  if (command.end != KnotEnd::neither) {
    contact_patch(segments, scene, command.contact, command.end == KnotEnd::last, patch);
  }
  if (!patch.empty()) {
    WrenchSum along_a(model), along_b(model);
    cosine = 0;
    for (const auto& [contact, share] : patch) {
      along_a.add(at(contact, true), kin, share);
      along_b.add(at(contact, false), kin, share);
      cosine += share * cosine_of(contact);
    }
    rows[0].patch = along_a.of_bodies();
    rows[1].patch = along_b.of_bodies();
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
    std::array<Row, 2> pair = eq6_rows(model, place.kin, place.segments, command, scene);
    for (const bool on_a : {true, false}) {
      Row& row = rows.emplace_back(std::move(pair[on_a ? 0 : 1]));
      row.id = thigmotaxis_row_id(command.end, command.contact, on_a);
      row.command = static_cast<int>(k);
      // The soft row: its L1 slack is the dual of this bound.
      row.upper = command.effort * scene.controller.cap * h;
    }
  }
}

}  // namespace hagfish
