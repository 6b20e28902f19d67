// A scene written as text and read again is the same to the last bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "core/input/run_time_text.hpp"
#include "tests/support/plain_scene.hpp"

namespace hagfish::scene_text_test {

const std::string data = HAGFISH_DATA_DIR;

/// Every number of a scene and a specimen as bits, and every name. A member more or less of any
/// structure, and this does not compile.
class Bits {
 public:
  Bits(const Scene& scene, const Specimen& specimen) {
    // The name of the specimen's file is not written.
    const auto& [title, file, mirror, clamp_head, gravity, model, drag, constraints, contact, flesh,
                 wall, obstacles, start, script, active, muscle, controller, food, knot, time,
                 guard, expect] = scene;
    add(title, mirror, clamp_head, gravity, model, drag, constraints, contact, flesh, wall,
        obstacles, start, script, active, muscle, controller, food, knot, time, guard, expect,
        specimen);
  }
  bool operator==(const Bits&) const = default;

 private:
  template <class... Values>
  void add(const Values&... values) {
    (put(values), ...);
  }
  void put(double value) { bits_.push_back(std::bit_cast<std::uint64_t>(value)); }
  template <class T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void put(T value) { bits_.push_back(static_cast<std::uint64_t>(value)); }
  void put(const std::string& value) { put(std::vector<char>(value.begin(), value.end())); }
  template <class T>
  void put(const std::vector<T>& values) {
    put(values.size());
    for (const T& value : values) put(value);
  }
  template <int rows, int columns>
  void put(const Eigen::Matrix<double, rows, columns>& values) {
    for (const double value : values.reshaped()) put(value);
  }
  void put(const ModelSettings& s) {
    const auto& [bodies, joints, passive, bending_stiffness, bending_damping, twist_stiffness,
                 twist_damping, largest_limit, limit_scale, mass_ratio, bending_limit] = s;
    add(bodies, joints, passive, bending_stiffness, bending_damping, twist_stiffness, twist_damping,
        largest_limit, limit_scale, mass_ratio, bending_limit);
  }
  void put(const DragSettings& s) {
    const auto& [normal, tangential] = s;
    add(normal, tangential);
  }
  void put(const ConstraintSettings& s) {
    const auto& [activation, baumgarte, baumgarte_speed, tolerance, corrections, stride] = s;
    add(activation, baumgarte, baumgarte_speed, tolerance, corrections, stride);
  }
  void put(const ContactSettings& s) {
    const auto& [margin, least_arc] = s;
    add(margin, least_arc);
  }
  void put(const WallSettings& s) {
    const auto& [present, neck] = s;
    add(present, neck);
  }
  void put(const Obstacle& s) {
    const auto& [name, shape] = s;
    add(name);
    std::visit([this](const auto& one) { put(one); }, shape);
  }
  void put(const Plane& s) {
    const auto& [point, normal, neck] = s;
    add(point, normal, neck);
  }
  void put(const Strand& s) {
    const auto& [points, radius, closed] = s;
    add(points, radius, closed);
  }
  void put(const Waypoint& s) {
    const auto& [time, value, noise] = s;
    add(time, value, noise);
  }
  void put(const CurvatureProgram& s) {
    const auto& [time, station, value, noise] = s;
    add(time, station, value, noise);
  }
  void put(const ScriptSettings& s) {
    const auto& [kind, curvature, knots, spring, damper, largest_force, noise, noise_seed] = s;
    add(kind, curvature, knots, spring, damper, largest_force, noise, noise_seed);
  }
  void put(const ActiveSettings& s) {
    const auto& [stiffness, tone_time, relax_time, capacity, bounds_laws] = s;
    add(stiffness, tone_time, relax_time, capacity, bounds_laws);
  }
  void put(const ThigmotaxisSpeeds& s) {
    const auto& [a, b] = s;
    add(a, b);
  }
  void put(const KnotSpeedSettings& s) {
    const auto& [target, gain, filter, most] = s;
    add(target, gain, filter, most);
  }
  void put(const ReducedBasisSettings& s) {
    const auto& [frame, margin, smooth, cosines, file, stations, bend_y, bend_z, twist, period,
                 filter, softness, most, places, played] = s;
    add(frame, margin, smooth, cosines, file, stations, bend_y, bend_z, twist, period, filter,
        softness, most, places, played);
  }
  void put(const ReflexSettings& s) {
    const auto& [shift, pull_shift, bend_y, bend_z, twist, gate, reach, delay, noise, seed] = s;
    add(shift, pull_shift, bend_y, bend_z, twist, gate, reach, delay, noise, seed);
  }
  void put(const ControllerSettings& s) {
    const auto& [law, eq6_at, eq6_slip, knot_speed, reduced_basis, reflex, tighten_head,
                 tighten_tail, slide_head, slide_tail, reverse_head, reverse_tail, leave_by,
                 free_from, cap, contact_gap, contact_patch, tail_through, tighten_from, tight_span,
                 tight_hold, tighten_time, release_at, untied_for, free_time] = s;
    add(law, eq6_at, eq6_slip, knot_speed, reduced_basis, reflex, tighten_head, tighten_tail,
        slide_head, slide_tail, reverse_head, reverse_tail, leave_by, free_from, cap, contact_gap,
        tail_through, tighten_from, tight_span, tight_hold, tighten_time, release_at, untied_for,
        free_time);
  }
  void put(const Ramp& s) {
    const auto& [from, to, time] = s;
    add(from, to, time);
  }
  void put(const FoodSettings& s) {
    const auto& [hold, strength, average, cap] = s;
    add(hold, strength, average, cap);
  }
  void put(const StartSettings& s) {
    const auto& [bend, bend_rate, spin, q, qdot, noise, seed, phase] = s;
    add(bend, bend_rate, spin, q, qdot, noise, seed, phase);
  }
  void put(const KnotSettings& s) {
    const auto& [votes, seed, interval, mirror] = s;
    add(votes, seed, interval, mirror);
  }
  void put(const TimeSettings& s) {
    const auto& [rule, momentum, step, settled, passes, ring_damping, frame_interval, duration,
                 until] = s;
    add(rule, momentum, step, settled, passes, ring_damping, frame_interval, duration, until);
  }
  void put(const GuardSettings& s) {
    const auto& [action, penetration, limit_violation, speed, energy_gain, energy_action,
                 capped_time] = s;
    add(action, penetration, limit_violation, speed, energy_gain, energy_action, capped_time);
  }
  void put(const KnotStretch& s) {
    const auto& [type, from, to] = s;
    add(type, run_time_text(from), run_time_text(to));
  }
  void put(const ExpectSettings& s) {
    const auto& [knot, types, hand, slide_distance, slide_share, reverse_distance, out_of,
                 torque_share, pull, pull_settled, pull_drift, pull_balance, speed_share,
                 penetration, overlap, skin_fold, limit_violation, head_drift, kkt, energy,
                 energy_gain, energy_loss, momentum] = s;
    add(knot, types, hand, slide_distance, slide_share, reverse_distance, out_of, torque_share,
        pull, pull_settled, pull_drift, pull_balance, speed_share, penetration, overlap, skin_fold,
        limit_violation, head_drift, kkt, energy, energy_gain, energy_loss, momentum);
  }
  void put(const Specimen& s) {
    const auto& [name, length, mass, station, circumference, bending_limit, bending_span,
                 twist_limit, bending_stiffness, bending_damping, twist_stiffness, twist_damping,
                 muscle, flesh] = s;
    add(name, length, mass, station, circumference, bending_limit, bending_span, twist_limit,
        bending_stiffness, bending_damping, twist_stiffness, twist_damping, muscle, flesh);
  }
  void put(const MuscleTissue& s) {
    const auto& [longitudinal_area, oblique_area, stress, radius_share, oblique_angle] = s;
    add(longitudinal_area, oblique_area, stress, radius_share, oblique_angle);
  }
  void put(const FleshTissue& s) {
    const auto& [stiffness_range, least_area] = s;
    add(stiffness_range, least_area);
  }
  void put(const FleshSettings& s) {
    const auto& [stiffness, relaxation, spacing] = s;
    add(stiffness, relaxation, spacing);
  }
  void put(const MuscleSettings& s) {
    const auto& [present, activation_time] = s;
    add(present, activation_time);
  }

  std::vector<std::uint64_t> bits_;
};

/// A scene in which every number differs from its default and has no short decimal form.
ResolvedScene odd_scene() {
  double next = 0.01;
  const auto odd = [&next] { return next += 1.0 / 197; };
  ResolvedScene result;
  Scene& s = result.scene;
  s.title = "odd \"title\"";
  s.clamp_head = false;
  s.gravity = {odd(), -odd(), odd()};
  s.model = {7,
             JointLayout::universal,
             PassiveSource::specimen,
             odd(),
             odd(),
             odd(),
             odd(),
             odd(),
             odd(),
             odd(),
             BendingLimit::cone};
  s.drag = {odd(), odd()};
  s.constraints = {Activation::violated, odd()};
  s.contact = {odd(), odd()};
  s.wall = {false, odd()};
  Plane plane;
  plane.point = {odd() - 100, odd(), odd()};  // clear of the body
  plane.normal = Eigen::Vector3d(1, 0.1 * odd(), 0.1 * odd()).normalized();
  plane.neck = odd();
  s.obstacles.push_back({"a plane", plane});
  Strand strand;
  strand.points = {{odd(), odd(), odd() + 50}, {odd(), odd(), odd() + 51}, {odd(), 9, odd() + 52}};
  strand.radius = odd();
  strand.closed = true;
  s.obstacles.push_back({"a strand", strand});
  s.script.kind = ScriptSettings::Kind::position;
  s.script.waypoints = {{0, {odd(), odd(), odd()}}, {odd(), {-odd(), odd(), odd()}}};
  s.script.spring = odd();
  s.script.damper = odd();
  s.script.largest_force = odd();
  s.active = {odd(), odd(), odd(), odd()};
  s.muscle = {true, odd()};
  s.controller = {
      "knot_speed",
      Eq6Point::centreline,
      Eq6Slip::shape,
      {odd(), odd(), odd(), odd()},
      {BasisFrame::body,
       odd(),
       odd(),
       0,
       "",
       {odd(), odd()},
       {odd(), odd()},
       {odd(), odd()},
       {odd(), odd()},
       odd(),
       odd(),
       odd(),
       odd(),
       {odd(), odd()},
       {odd(), odd()}},
      {odd(), -odd(), true, false, true, ReflexGate::touch, odd(), odd(), odd() / 10, 3},
      {odd(), odd()},
      {odd(), odd()},
      {odd(), odd()},
      {odd(), odd()},
      {odd(), odd()},
      {odd(), odd()},
      BodyEnd::tail,
      Phase::tighten,
      odd(),
      odd(),
      odd(),
      odd(),
      odd(),
      odd(),
      odd(),
      odd(),
      odd(),
      odd()};
  s.knot = {3, 4294967295u, odd()};
  s.controller.contact_gap = s.contact.margin / 3;
  s.time.rule = TimeRule::midpoint;
  s.time.step = odd();
  s.time.momentum = FreeMomentum::rule;
  s.time.settled = odd();
  s.time.passes = 7;
  s.time.frame_interval = 3 * s.time.step;
  s.time.duration = 7 * s.time.step;
  s.constraints.baumgarte_speed = odd();
  s.constraints.tolerance = odd();
  s.constraints.corrections = 5;
  s.constraints.stride = odd();
  s.guard = {GuardAction::warn, odd(), odd(), odd(), odd(), EnergyAction::stop, odd()};
  s.time.until = Phase::reverse;
  s.expect.knot = "4_1";
  s.expect.types = {{"0_1", {std::nullopt, 0}, {std::nullopt, odd()}},
                    {"det=9,v2=2", {Phase::tighten, odd()}, {std::nullopt, INFINITY}}};
  s.expect.hand = Hand::left;
  s.expect.out_of = "a plane";
  for (double ExpectSettings::*each :
       {&ExpectSettings::slide_distance, &ExpectSettings::slide_share,
        &ExpectSettings::reverse_distance, &ExpectSettings::torque_share,
        &ExpectSettings::speed_share, &ExpectSettings::penetration, &ExpectSettings::skin_fold,
        &ExpectSettings::limit_violation, &ExpectSettings::head_drift, &ExpectSettings::kkt}) {
    s.expect.*each = odd();
  }
  s.expect.pull = odd();
  s.expect.pull_settled = odd();
  s.expect.pull_drift = odd();
  s.expect.pull_balance = odd();
  s.food = {0, odd(), odd(), {odd(), odd(), odd()}};  // none, as the head is free
  s.flesh = {odd(), odd(), odd()};
  s.expect.overlap = odd();
  s.expect.energy = odd();
  s.expect.energy_gain = odd();
  s.expect.energy_loss = odd();
  s.expect.momentum = odd();
  s.active.bounds_laws = true;
  s.start.bend = {{odd(), odd(), -odd(), odd()}, {odd(), odd(), odd(), odd()}};
  for (int i = 0; i < 6 + 12; ++i) s.start.qdot.push_back(odd());  // of 7 bodies
  s.start.noise = odd();
  s.start.seed = 4294967294u;
  s.start.phase = Phase::slide;
  result.specimen = {"odd",
                     50 + odd(),
                     odd(),
                     {odd(), odd(), odd()},
                     {odd(), odd(), odd()},
                     {odd(), odd(), odd()},
                     odd(),
                     odd(),
                     {odd(), odd(), odd()},
                     {odd(), odd(), odd()},
                     {odd(), odd(), odd()},
                     {odd(), odd(), odd()},
                     {{odd(), odd(), odd()}, {odd(), odd(), odd()}, odd(), odd(), odd()},
                     {{odd(), 50 + odd()}, odd() / 3}};
  return result;
}

TEST(SceneText, ResolvedTextGivesTheSameScene) {
  for (const auto& [scene, specimen] :
       {odd_scene(), read_scene(data + "/table1.toml"),
        read_scene(data + "/overhand_waypoints.toml"), read_scene(data + "/overhand_reverse.toml"),
        read_scene(data + "/pull_morsel.toml"), read_scene(data + "/living_overhand_free.toml")}) {
    const std::string text = scene_to_toml(scene, specimen);
    const ResolvedScene again = read_scene_text(text, "resolved");
    EXPECT_TRUE(Bits(again.scene, again.specimen) == Bits(scene, specimen));
    EXPECT_EQ(again.scene.title, scene.title);
    EXPECT_EQ(again.scene.expect.knot, scene.expect.knot);
    EXPECT_EQ(again.specimen.name, specimen.name);
    EXPECT_EQ(scene_to_toml(again.scene, again.specimen), text);
  }
}

TEST(SceneText, ResolvedTextOfAMirroredNoisySceneGivesTheSameScene) {
  const auto [scene, specimen] =
      read_scene(data + "/double_overhand.toml", {"mirror=true", "script.noise=0.3"});
  const std::string text = scene_to_toml(scene, specimen);
  const ResolvedScene again = read_scene_text(text, "resolved");
  EXPECT_TRUE(Bits(again.scene, again.specimen) == Bits(scene, specimen));
  EXPECT_EQ(again.scene.expect.types.at(2).type, "5_1");
  EXPECT_EQ(scene_to_toml(again.scene, again.specimen), text);
}

TEST(SceneText, ResolvedTextOfAMirroredNoisyProgramGivesTheSameScene) {
  const auto [scene, specimen] =
      read_scene(data + "/living_three_twist.toml", {"mirror=true", "script.noise=0.3"});
  const ResolvedScene again = read_scene_text(scene_to_toml(scene, specimen), "resolved");
  EXPECT_TRUE(Bits(again.scene, again.specimen) == Bits(scene, specimen));
}

TEST(SceneText, DefaultsAreThoseOfSettings) {
  const auto [scene, specimen] = read_scene_text(plain_scene, "plain");
  EXPECT_TRUE(Bits(scene, specimen) == Bits(Scene{}, specimen));
}

}  // namespace hagfish::scene_text_test
