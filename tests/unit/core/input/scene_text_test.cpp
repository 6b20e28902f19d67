// A scene written as text and read again is the same to the last bit.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/input/run_time_text.hpp"
#include "tests/support/plain_scene.hpp"
#include "tests/unit/core/input/members.hpp"

namespace hagfish::scene_text_test {

const std::string data = HAGFISH_DATA_DIR;

/// Every number of a scene and a specimen as bits, and every name, whatever members they have.
class Bits {
 public:
  Bits(Scene scene, const Specimen& specimen) {
    scene.specimen.clear();  // the name of the specimen's file is not written
    put(scene);
    put(specimen);
  }
  bool operator==(const Bits&) const = default;

 private:
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
  template <class... Shapes>
  void put(const std::variant<Shapes...>& shape) {
    std::visit([this](const auto& one) { put(one); }, shape);
  }
  void put(const RunTime& time) { put(run_time_text(time)); }
  template <class T>
  requires std::is_aggregate_v<T>
  void put(const T& s) {
    for_each_member(s, [this](const auto& member) { put(member); });
  }

  std::vector<std::uint64_t> bits_;
};

/// Other numbers and choices than the defaults; numbers differ and have no short decimal form.
class Odd {
 public:
  double number() { return last_ += 1.0 / 197; }
  std::vector<double> numbers(int count) {
    std::vector<double> all(count);
    for (double& x : all) x = number();
    return all;
  }
  /// Of every member but texts, lists and whole numbers with a sign.
  template <class T>
  void change(T& member) {
    if constexpr (std::is_same_v<T, double>) {
      member = number();
    } else if constexpr (std::is_same_v<T, bool>) {
      member = !member;
    } else if constexpr (std::is_same_v<T, unsigned>) {
      member = 4294967295U;
    } else if constexpr (std::is_enum_v<T>) {
      member = static_cast<T>(static_cast<int>(member) == 0 ? 1 : 0);
    } else if constexpr (std::is_same_v<T, Eigen::Vector3d>) {
      member = {number(), -number(), number()};
    } else if constexpr (std::is_aggregate_v<T>) {
      for_each_member(member, [this](auto& one) { change(one); });
    }
  }

 private:
  double last_ = 0.01;
};

/// A scene in which every number differs from its default and has no short decimal form.
ResolvedScene odd_scene() {
  Odd odd;
  ResolvedScene result;
  Scene& s = result.scene;
  odd.change(s);
  s.title = "odd \"title\"";
  s.mirror = s.knot.mirror = false;  // a state that is given cannot be mirrored
  s.model.bodies = 7;
  s.constraints.corrections = 5;
  Plane plane;
  odd.change(plane);
  plane.point.x() -= 100;  // clear of the body
  plane.normal = Eigen::Vector3d(1, 0.1 * odd.number(), 0.1 * odd.number()).normalized();
  s.obstacles.push_back({"a plane", plane});
  Strand strand;
  odd.change(strand);
  for (int k = 0; k < 3; ++k) {
    strand.points.emplace_back(odd.number(), k == 2 ? 9 : odd.number(), odd.number() + 50 + k);
  }
  s.obstacles.push_back({"a strand", strand});
  s.script.kind = ScriptSettings::Kind::position;
  s.script.waypoints.resize(2);
  for (Waypoint& knot : s.script.waypoints) odd.change(knot.value);
  s.script.waypoints[1].time = odd.number();
  s.script.noise = 0;  // drawn anew by whoever reads it
  s.controller.law = "knot_speed";
  ReducedBasisSettings& basis = s.controller.reduced_basis;
  for (std::vector<double>* list : {&basis.stations, &basis.bend_y, &basis.bend_z, &basis.twist,
                                    &basis.places, &basis.played}) {
    *list = odd.numbers(2);
  }
  s.controller.free_from = Phase::tighten;
  s.controller.contact_gap = s.contact.margin / 3;
  s.food.hold = 0;  // none, as the head is free
  s.knot.votes = 3;
  s.time.passes = 7;
  s.time.frame_interval = 3 * s.time.step;
  s.time.duration = 7 * s.time.step;
  s.time.until = Phase::reverse;
  s.guard.energy_action = EnergyAction::stop;
  s.expect.knot = "4_1";
  s.expect.types = {{"0_1", {std::nullopt, 0}, {std::nullopt, odd.number()}},
                    {"det=9,v2=2", {Phase::tighten, odd.number()}, {std::nullopt, INFINITY}}};
  s.expect.hand = Hand::left;
  s.expect.out_of = "a plane";
  for (int k = 0; k < 2; ++k) {
    s.start.bend.emplace_back(odd.number(), odd.number(), -odd.number(), odd.number());
  }
  s.start.qdot = odd.numbers(6 + 12);  // of 7 bodies, in place of a spin
  s.start.spin.setZero();
  s.start.seed = 4294967294U;
  s.start.phase = Phase::slide;
  Specimen& animal = result.specimen;
  odd.change(animal);
  animal.name = "odd";
  animal.length += 50;
  for (std::vector<double>* profile :
       {&animal.station, &animal.circumference, &animal.bending_limit, &animal.bending_stiffness,
        &animal.bending_damping, &animal.twist_stiffness, &animal.twist_damping,
        &animal.muscle.longitudinal_area, &animal.muscle.oblique_area}) {
    *profile = odd.numbers(3);
  }
  animal.flesh.stiffness_range = {odd.number(), 50 + odd.number()};
  animal.flesh.least_area /= 3;
  return result;
}

TEST(SceneText, ResolvedTextGivesTheSameScene) {
  const std::vector<std::string> image = {"mirror=true", "script.noise=0.3"};
  for (const auto& [scene, specimen, _] :
       {odd_scene(), read_scene(data + "/table1.toml"),
        read_scene(data + "/overhand_waypoints.toml"), read_scene(data + "/overhand_reverse.toml"),
        read_scene(data + "/pull_morsel.toml"), read_scene(data + "/living_overhand_free.toml"),
        read_scene(data + "/double_overhand.toml", image),
        read_scene(data + "/living_three_twist.toml", image)}) {
    const std::string text = scene_to_toml(scene, specimen);
    const ResolvedScene again = read_scene_text(text, "resolved");
    EXPECT_TRUE(Bits(again.scene, again.specimen) == Bits(scene, specimen)) << scene.title;
    EXPECT_EQ(scene_to_toml(again.scene, again.specimen), text);
  }
}

TEST(SceneText, DefaultsAreThoseOfSettings) {
  const auto [scene, specimen, _] = read_scene_text(plain_scene, "plain");
  EXPECT_TRUE(Bits(scene, specimen) == Bits(Scene{}, specimen));
}

}  // namespace hagfish::scene_text_test
