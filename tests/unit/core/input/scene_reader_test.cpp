#include "core/input/scene_reader.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <functional>

#include "core/input/builtin_files.hpp"
#include "tests/support/input_errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace hagfish {
namespace {

const std::string data = HAGFISH_DATA_DIR;

/// A specimen without data files.
const std::string plain_specimen =
    "name = 'test'\nlength = 40\nmass = 80\nstation = [0.2, 0.8]\ncircumference = [5, 4]\n"
    "bending_limit_deg = [20, 30]\nbending_span = 0.8\ntwist_limit_deg = 48\n";
const std::string plain_scene = "[specimen]\n" + plain_specimen;

/// What reading the plain scene with `more` in front of it complains of.
std::string complaint(const std::string& more, const std::vector<std::string>& overrides = {}) {
  return error_of([&] { read_scene_text(more + plain_scene, "s.toml", overrides); });
}

std::string script(const std::string& knots) {
  return "[script]\nkind = 'force'\nknots = [\n" + knots + "]\n";
}

TEST(SceneReader, Table1FileIsThePapersScene) {
  const auto [scene, specimen] = read_scene(data + "/table1.toml");
  EXPECT_EQ(scene.specimen, "specimens/pacific_hagfish.toml");
  EXPECT_EQ(specimen.length, 42.4);
  EXPECT_TRUE(scene.clamp_head);
  EXPECT_EQ(scene.gravity, Eigen::Vector3d::Zero());
  EXPECT_EQ(scene.model.bodies, 100);
  EXPECT_EQ(scene.model.bending_stiffness, 500 * 0.848);
  EXPECT_EQ(scene.model.bending_damping, 0);
  // Four digits of 4 and 1 g/s per body of 0.424 cm.
  EXPECT_NEAR(scene.drag.normal, 4 / 0.424, 5e-4);
  EXPECT_NEAR(scene.drag.tangential, 1 / 0.424, 5e-4);
  EXPECT_EQ(scene.script.kind, ScriptSettings::Kind::force);
  ASSERT_EQ(scene.script.knots.size(), 12u);
  EXPECT_EQ(scene.script.knots[0].value, Eigen::Vector3d(564, -230, -31));
  EXPECT_EQ(scene.script.knots[11].time, 11);
  EXPECT_EQ(scene.script.knots[11].value, Eigen::Vector3d(-17, 16, 147));
  EXPECT_EQ(scene.controller.tighten_head.b, 0);
  EXPECT_EQ(scene.controller.tighten_tail.a, 0.5);
  EXPECT_EQ(scene.controller.tighten_tail.b, 2);
  EXPECT_EQ(scene.controller.slide_head.a, 2);
  EXPECT_EQ(scene.controller.slide_tail.b, 2);
  EXPECT_EQ(scene.time.step, 0.002);
}

TEST(SceneReader, WaypointFileIsInBodyLengths) {
  const auto [scene, specimen] = read_scene(data + "/overhand_waypoints.toml");
  EXPECT_EQ(scene.script.kind, ScriptSettings::Kind::position);
  EXPECT_EQ(scene.script.spring, 3000);
  EXPECT_EQ(scene.script.damper, 60);
  EXPECT_EQ(scene.script.largest_force, 1200);
  ASSERT_EQ(scene.script.knots.size(), 14u);
  EXPECT_EQ(scene.script.knots[2].time, 2);
  EXPECT_EQ(scene.script.knots[2].value, Eigen::Vector3d(0.849, 0.283, 0) * 42.4);
}

/// Every number of a scene and a specimen, in a fixed order, as bits.
std::vector<std::uint64_t> bits(const Scene& s, const Specimen& animal) {
  std::vector<double> x = {double(s.clamp_head),
                           s.gravity.x(),
                           s.gravity.y(),
                           s.gravity.z(),
                           double(s.model.bodies),
                           s.model.bending_stiffness,
                           s.model.bending_damping,
                           s.model.twist_stiffness,
                           s.model.twist_damping,
                           s.model.largest_limit,
                           s.model.limit_scale,
                           s.model.mass_ratio,
                           double(s.model.bending_limit),
                           s.drag.normal,
                           s.drag.tangential,
                           double(s.constraints.activation),
                           s.constraints.baumgarte,
                           s.constraints.baumgarte_speed,
                           s.constraints.tolerance,
                           double(s.constraints.corrections),
                           s.constraints.stride,
                           s.contact.margin,
                           s.contact.least_arc,
                           double(s.wall.present),
                           s.wall.neck,
                           double(s.script.kind),
                           s.script.spring,
                           s.script.damper,
                           s.script.largest_force,
                           s.controller.tighten_head.a,
                           s.controller.tighten_head.b,
                           s.controller.tighten_tail.a,
                           s.controller.tighten_tail.b,
                           s.controller.slide_head.a,
                           s.controller.slide_head.b,
                           s.controller.slide_tail.a,
                           s.controller.slide_tail.b,
                           s.controller.reverse_head.a,
                           s.controller.reverse_head.b,
                           s.controller.reverse_tail.a,
                           s.controller.reverse_tail.b,
                           double(s.controller.leave_by),
                           double(s.controller.free_from),
                           s.controller.tighten_from,
                           s.controller.untied_for,
                           double(s.mirror),
                           s.script.noise,
                           double(s.script.noise_seed),
                           double(s.time.until),
                           double(s.expect.hand),
                           s.expect.reverse_distance,
                           s.controller.cap,
                           s.controller.acceleration,
                           s.controller.contact_gap,
                           s.controller.hysteresis,
                           s.controller.tail_through,
                           s.controller.tight_span,
                           s.controller.tighten_time,
                           s.controller.release_at,
                           s.controller.free_time,
                           double(s.knot.votes),
                           double(s.knot.seed),
                           s.knot.interval,
                           s.time.step,
                           s.time.frame_interval,
                           s.time.duration,
                           double(s.guard.action),
                           s.guard.energy_gain,
                           double(s.guard.energy_action),
                           s.guard.capped_time,
                           s.guard.penetration,
                           s.guard.limit_violation,
                           s.guard.speed,
                           s.expect.slide_distance,
                           s.expect.speed_share,
                           s.expect.penetration,
                           s.expect.limit_violation,
                           s.expect.head_drift,
                           s.expect.kkt,
                           s.expect.force_balance,
                           s.expect.energy,
                           s.expect.energy_gain,
                           s.start.spin.x(),
                           s.start.spin.y(),
                           s.start.spin.z(),
                           s.start.noise,
                           double(s.start.seed),
                           double(s.start.phase),
                           animal.length,
                           animal.mass,
                           animal.bending_span,
                           animal.twist_limit};
  for (const auto& knot : s.script.knots) {
    x.insert(x.end(), {knot.time, knot.value.x(), knot.value.y(), knot.value.z(), knot.noise.x(),
                       knot.noise.y(), knot.noise.z()});
  }
  for (const KnotStretch& stretch : s.expect.types) {
    x.insert(x.end(), {stretch.from, stretch.to});
  }
  for (const auto* rows : {&s.start.bend, &s.start.bend_rate}) {
    for (const Eigen::Vector4d& row : *rows) x.insert(x.end(), row.data(), row.data() + 4);
  }
  for (const auto* whole : {&s.start.q, &s.start.qdot}) {
    x.insert(x.end(), whole->begin(), whole->end());
  }
  for (const auto* profile : {&animal.station, &animal.circumference, &animal.bending_limit}) {
    x.insert(x.end(), profile->begin(), profile->end());
  }
  std::vector<std::uint64_t> result;
  for (const double value : x) result.push_back(std::bit_cast<std::uint64_t>(value));
  return result;
}

/// A scene in which every number differs from its default and has no short decimal form.
ResolvedScene odd_scene() {
  double next = 0.01;
  const auto odd = [&next] { return next += 1.0 / 197; };
  ResolvedScene result;
  Scene& s = result.scene;
  s.title = "odd \"title\"";
  s.clamp_head = false;
  s.gravity = {odd(), -odd(), odd()};
  s.model = {7, odd(), odd(), odd(), odd(), odd(), odd(), odd(), BendingLimit::cone};
  s.drag = {odd(), odd()};
  s.constraints = {Activation::violated, odd()};
  s.contact = {odd(), odd()};
  s.wall = {false, odd()};
  s.script.kind = ScriptSettings::Kind::position;
  s.script.knots = {{0, {odd(), odd(), odd()}}, {odd(), {-odd(), odd(), odd()}}};
  s.script.spring = odd();
  s.script.damper = odd();
  s.script.largest_force = odd();
  s.controller = {{odd(), odd()}, {odd(), odd()}, {odd(), odd()}, {odd(), odd()}, {odd(), odd()},
                  {odd(), odd()}, BodyEnd::tail,  Phase::tighten, odd(),          odd(),
                  odd(),          odd(),          odd(),          odd(),          odd(),
                  odd(),          odd(),          odd(),          odd(),          odd()};
  s.knot = {3, 4294967295u, odd()};
  s.controller.contact_gap = s.contact.margin / 3;
  s.time.step = odd();
  s.time.frame_interval = 3 * s.time.step;
  s.time.duration = 7 * s.time.step;
  s.constraints.baumgarte_speed = odd();
  s.constraints.tolerance = odd();
  s.constraints.corrections = 5;
  s.constraints.stride = odd();
  s.guard = {GuardAction::warn, odd(), odd(), odd(), odd(), EnergyAction::stop, odd()};
  s.time.until = Phase::reverse;
  s.expect = {"4_1",      {{"0_1", 0, odd()}, {"det=9,v2=2", odd(), odd()}},
              Hand::left, odd(),
              odd(),      odd(),
              odd(),      odd(),
              odd(),      odd(),
              odd(),      odd()};
  s.expect.energy_gain = odd();
  s.start.bend = {{odd(), odd(), -odd(), odd()}, {odd(), odd(), odd(), odd()}};
  for (int i = 0; i < 6 + 9; ++i) s.start.qdot.push_back(odd());  // of 7 bodies
  s.start.noise = odd();
  s.start.seed = 4294967294u;
  s.start.phase = Phase::slide;
  result.specimen = {
      "odd", 50 + odd(), odd(), {odd(), odd(), odd()}, {odd(), odd(), odd()}, {odd(), odd(), odd()},
      odd(), odd()};
  return result;
}

TEST(SceneReader, ResolvedTextGivesTheSameScene) {
  for (const auto& [scene, specimen] : {odd_scene(), read_scene(data + "/table1.toml"),
                                        read_scene(data + "/overhand_waypoints.toml"),
                                        read_scene(data + "/overhand_reverse.toml")}) {
    const std::string text = scene_to_toml(scene, specimen);
    const ResolvedScene again = read_scene_text(text, "resolved");
    EXPECT_EQ(bits(again.scene, again.specimen), bits(scene, specimen));
    EXPECT_EQ(again.scene.title, scene.title);
    EXPECT_EQ(again.scene.expect.knot, scene.expect.knot);
    EXPECT_EQ(again.specimen.name, specimen.name);
    EXPECT_EQ(scene_to_toml(again.scene, again.specimen), text);
  }
}

TEST(SceneReader, ResolvedTextOfAMirroredNoisySceneGivesTheSameScene) {
  const auto [scene, specimen] =
      read_scene(data + "/double_overhand.toml", {"mirror=true", "script.noise=0.3"});
  const std::string text = scene_to_toml(scene, specimen);
  const ResolvedScene again = read_scene_text(text, "resolved");
  EXPECT_EQ(bits(again.scene, again.specimen), bits(scene, specimen));
  EXPECT_EQ(again.scene.expect.types.at(2).type, "5_1");
  EXPECT_EQ(scene_to_toml(again.scene, again.specimen), text);
}

TEST(SceneReader, DefaultsAreThoseOfSettings) {
  const auto [scene, specimen] = read_scene_text(plain_scene, "plain");
  EXPECT_EQ(bits(scene, specimen), bits(Scene{}, specimen));
}

TEST(SceneReader, BuiltInFilesAreTheDataFiles) {
  for (const std::string name : {"table1.toml", "overhand_waypoints.toml"}) {
    ASSERT_TRUE(builtin_file(name));
    const auto built_in = read_scene_text(std::string(*builtin_file(name)), name + " (built in)");
    const auto on_disk = read_scene(data + "/" + name);
    EXPECT_EQ(bits(built_in.scene, built_in.specimen), bits(on_disk.scene, on_disk.specimen));
  }
  EXPECT_FALSE(builtin_file("table2.toml"));
}

TEST(SceneReader, OverridesReachSceneAndSpecimen) {
  const auto [scene, specimen] =
      read_scene(data + "/table1.toml",
                 {"time.step=0.005", "title=a b", "constraints.activation=violated",
                  "controller.tighten_tail.b=1", "specimen.mass=90", "script.kind=none"});
  EXPECT_EQ(scene.time.step, 0.005);
  EXPECT_EQ(scene.title, "a b");
  EXPECT_EQ(scene.constraints.activation, Activation::violated);
  EXPECT_EQ(scene.controller.tighten_tail.a, 0.5);
  EXPECT_EQ(scene.controller.tighten_tail.b, 1);
  EXPECT_EQ(specimen.mass, 90);
  EXPECT_TRUE(scene.script.knots.empty());
  EXPECT_EQ(read_scene_text(plain_scene, "s", {"specimen.mass=70"}).specimen.mass, 70);
}

TEST(SceneReader, SpecimenFileIsBesideTheSceneOrWhereTheOptionSays) {
  const TemporaryFolder folder;
  folder.write("animal.toml", plain_specimen);
  const std::string scene = folder.write("sub/scene.toml", "specimen = '../animal.toml'\n");
  EXPECT_EQ(read_scene(scene).specimen.length, 40);
  const auto changed = read_scene_text("specimen = 'table1.toml'\n", "built in",
                                       {"specimen=" + (folder / "animal.toml").string()});
  EXPECT_EQ(changed.specimen.length, 40);
}

TEST(SceneReader, TellsMissingAndUnreadableFiles) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_of([] { read_scene("no/such.toml"); }), "no/such.toml: no such file");
  EXPECT_EQ(error_of([] { read_specimen("no/such.toml"); }), "no/such.toml: no such file");
  EXPECT_EQ(error_of([&] { read_scene(folder.path()); }),
            folder.path().string() + ": is a directory");
  EXPECT_EQ(error_of([&] { read_specimen(folder.path()); }),
            folder.path().string() + ": is a directory");
  const std::string scene = folder.write("scene.toml", "title = ''\nspecimen = 'gone.toml'\n");
  EXPECT_EQ(
      error_of([&] { read_scene(scene); }),
      scene + ":2: specimen = 'gone.toml': " + (folder / "gone.toml").string() + ": no such file");
  EXPECT_EQ(error_of([] { read_scene_text("specimen = 'gone.toml'", "s"); }),
            "s:1: specimen = 'gone.toml': no such built-in file");
  EXPECT_EQ(error_of([] { read_scene_text("", "s", {"specimen=gone.toml"}); }),
            "s: --set specimen=gone.toml: gone.toml: no such file");
  EXPECT_EQ(error_of([] { read_scene_text("title = 'x'", "s"); }),
            "s: specimen: is missing: a file name or a table");
}

TEST(SceneReader, TellsSyntaxErrors) {
  EXPECT_EQ(
      complaint("title = \n"),
      "s.toml:1: not valid TOML: missing value after key-value separator '=' (expected value, "
      "but got nothing)");
}

TEST(SceneReader, RefusesUnknownKeys) {
  EXPECT_EQ(complaint("[controler]\ncap = 1\n"),
            "s.toml:1: controler: unknown key; did you mean controller?");
  EXPECT_EQ(complaint("[time]\nsteps = 1\n"),
            "s.toml:2: time.steps = 1: unknown key; did you mean time.step?");
  EXPECT_EQ(
      complaint("[model]\nlargest_limit = 1\n"),
      "s.toml:2: model.largest_limit = 1: unknown key; did you mean model.largest_limit_deg?");
}

TEST(SceneReader, RefusesBadValues) {
  EXPECT_EQ(complaint("title = 3\n"), "s.toml:1: title = 3: must be a string in quotes");
  EXPECT_EQ(complaint("[model]\nbodies = 1\n"),
            "s.toml:2: model.bodies = 1: must be from 2 to 400");
  EXPECT_EQ(complaint("[model]\nbodies = 401\n"),
            "s.toml:2: model.bodies = 401: must be from 2 to 400");
  EXPECT_EQ(complaint("[model]\nlargest_limit_deg = 90\n"),
            "s.toml:2: model.largest_limit_deg = 90: must be above 0 and below 90 degrees");
  EXPECT_EQ(complaint("[model]\nbending_limit = 'ball'\n"),
            "s.toml:2: model.bending_limit = 'ball': must be one of \"box\", \"cone\"");
  EXPECT_EQ(complaint("[drag]\nnormal = nan\n"), "s.toml:2: drag.normal = nan: must be finite");
  EXPECT_EQ(complaint("[drag]\ntangential = -1\n"),
            "s.toml:2: drag.tangential = -1: must not be negative");
  EXPECT_EQ(complaint("[constraints]\nbaumgarte = 1.5\n"),
            "s.toml:2: constraints.baumgarte = 1.5: must be from 0 to 1");
  EXPECT_EQ(complaint("[time]\nstep = 0.0\n"), "s.toml:2: time.step = 0.0: must be positive");
  EXPECT_EQ(complaint("[time]\nframe_interval = 0.001\n"),
            "s.toml:2: time.frame_interval = 0.001: must not be less than time.step, 0.002");
  EXPECT_EQ(complaint("[time]\nstep = 0.05\n"),
            "s.toml: time.frame_interval: must not be less than time.step, 0.05");
  EXPECT_EQ(complaint("[time]\nduration = 0.001\n"),
            "s.toml:2: time.duration = 0.001: must not be less than time.step, 0.002");
}

TEST(SceneReader, RefusesBadOverrides) {
  EXPECT_EQ(complaint("", {"time.stop=1"}),
            "s.toml: --set time.stop=1: unknown key; did you mean time.step?");
  EXPECT_EQ(complaint("", {"time.step=fast"}), "s.toml: --set time.step=fast: must be a number");
  EXPECT_EQ(complaint("", {"time.step"}), "--set time.step: must be KEY=VALUE");
  EXPECT_EQ(complaint("", {"constraints.activation=never"}),
            "s.toml: --set constraints.activation=never: must be one of \"speculative\", "
            "\"violated\"");
  EXPECT_EQ(error_of([] { read_scene(data + "/table1.toml", {"specimen.mass=0"}); }),
            data + "/specimens/pacific_hagfish.toml: --set specimen.mass=0: must be positive");
}

TEST(SceneReader, RefusesStartsThatDoNotFit) {
  EXPECT_EQ(complaint("[start]\nbend = [[0, 1, 2]]\n"),
            "s.toml:2: start.bend = [0, 1, 2]: row 1 must be four numbers [station, x, y, z]");
  EXPECT_EQ(
      complaint("[start]\nbend = [[0.5, 0, 0, 1], [0.5, 0, 0, 0]]\n"),
      "s.toml:2: start.bend = [0.5, 0, 0, 0]: stations must rise from 0 to 1; row 2 does not");
  EXPECT_EQ(
      complaint("[start]\nbend_rate = [[1.5, 0, 0, 1]]\n"),
      "s.toml:2: start.bend_rate = [1.5, 0, 0, 1]: stations must rise from 0 to 1; row 1 does "
      "not");
  EXPECT_EQ(complaint("[model]\nbodies = 2\n[start]\nq = [0, 0, 0, 1, 0, 0, 0]\n"),
            "s.toml:4: start.q = [0, 0, 0, 1, 0, 0, 0]: has 7 numbers; 2 bodies need 9");
  EXPECT_EQ(complaint("[model]\nbodies = 2\n[start]\nqdot = [0]\n"),
            "s.toml:4: start.qdot = [0]: has 1 numbers; 2 bodies need 8");
  EXPECT_EQ(complaint("[model]\nbodies = 2\n[start]\nq = [0, 0, 0, 0, 0, 0, 0, 0, 0]\n"),
            "s.toml:4: start.q = [0, 0, 0, 0, 0, 0, 0, 0, 0]: numbers 4 to 7 are a quaternion and "
            "must not all be 0");
  EXPECT_EQ(complaint("[start]\nspin = [1, 0, 0]\n"),
            "s.toml:2: start.spin = [1, 0, 0]: the head is clamped (clamp_head)");
  EXPECT_EQ(complaint("[start]\nbend = [[0, 0, 0, 1]]\nq = [1]\n"),
            "s.toml:3: start.q = [1]: start.bend is given too");
  EXPECT_EQ(complaint("[start]\nbend_rate = [[0, 0, 0, 1]]\nqdot = [1]\n"),
            "s.toml:3: start.qdot = [1]: start.bend_rate or start.spin is given too");
  EXPECT_EQ(complaint("[start]\nphase = 'tie'\n"),
            "s.toml:2: start.phase = 'tie': must be one of \"form\", \"tighten\", \"slide\", "
            "\"release\", \"free\"");
}

TEST(SceneReader, RefusesScriptsOutOfOrder) {
  EXPECT_EQ(complaint(script("[0, 1, 2, 3],\n[1, 1, 2, 3],\n[1, 4, 5, 6],\n")),
            "s.toml:6: script.knots = [1, 4, 5, 6]: knot 3 must be later than the one before it");
  EXPECT_EQ(complaint(script("[0.5, 1, 2, 3],\n[1, 1, 2, 3],\n")),
            "s.toml:4: script.knots = [0.5, 1, 2, 3]: knot 1 must be at time 0");
  EXPECT_EQ(complaint(script("[0, 1, 2, 3],\n[1, 1, 2],\n")),
            "s.toml:5: script.knots = [1, 1, 2]: knot 2 must be four numbers [t, x, y, z]");
  EXPECT_EQ(complaint("[script]\nkind = 'force'\nknots = [[0, 1, 2, 3]]\n"),
            "s.toml:3: script.knots = [[0, 1, 2, 3]]: a script needs two knots or more");
  EXPECT_EQ(complaint("[script]\nkind = 'force'\n"),
            "s.toml: script.knots: a script needs two knots or more");
}

TEST(SceneReader, RefusesScriptsOfTheWrongKind) {
  const std::string knots = "knots = [[0, 1, 2, 3], [1, 1, 2, 3]]\n";
  EXPECT_EQ(complaint("[script]\nkind = 'pull'\n"),
            "s.toml:2: script.kind = 'pull': must be one of \"none\", \"force\", \"position\"");
  EXPECT_EQ(complaint("[script]\nkind = 'force'\nunit = 'L'\n" + knots),
            "s.toml:3: script.unit = 'L': forces are in \"dyn\"");
  EXPECT_EQ(complaint("[script]\nkind = 'position'\nunit = 'dyn'\n" + knots),
            "s.toml:3: script.unit = 'dyn': positions are in \"L\" or \"cm\"");
  EXPECT_EQ(complaint("[script]\nkind = 'position'\nlargest_force = 1\n" + knots),
            "s.toml: script.spring: must be positive");
  EXPECT_EQ(complaint("[script]\nkind = 'position'\nspring = 1\n" + knots),
            "s.toml: script.largest_force: must be positive");
}

TEST(SpecimenReader, RefusesBadValues) {
  // Each takes the place of one key of the specimen.
  const auto why = [](const std::string& key, const std::string& value) {
    return complaint("", {"specimen." + key + "=" + value});
  };
  const auto told = [](const std::string& key, const std::string& value, const std::string& what) {
    return "s.toml: --set specimen." + key + "=" + value + ": " + what;
  };
  const auto expect = [&](const std::string& key, const std::string& value,
                          const std::string& what) {
    EXPECT_EQ(why(key, value), told(key, value, what));
  };
  expect("length", "0", "must be positive");
  expect("length", "nan", "must be finite");
  expect("mass", "-80", "must be positive");
  expect("mass", "heavy", "must be a number");
  expect("circumference", "[5, 0]", "number 2 must be positive");
  expect("circumference", "[5]", "must have as many values as station, 2");
  expect("bending_limit_deg", "[20, 30, 40]", "must have as many values as station, 2");
  expect("bending_limit_deg", "[20, -30]", "number 2 must be above 0 and below 180 degrees");
  expect("bending_limit_deg", "[0, 30]", "number 1 must be above 0 and below 180 degrees");
  expect("bending_span", "41", "must not exceed the length, 40");
  expect("twist_limit_deg", "-48", "must be positive");
  expect("station", "[0.8, 0.2]", "must rise; station 2 does not");
  expect("station", "[0.2, 0.2]", "must rise; station 2 does not");
  expect("station", "[0.2, 1.5]", "number 2 must be from 0 to 1");
  expect("station", "[]", "must be an array of numbers");
}

TEST(SpecimenReader, NamesTheFileAndTheMissingKey) {
  const TemporaryFolder folder;
  const std::string file = folder.write("animal.toml", "name = 'x'\nlength = 40\nmass = 0\n");
  EXPECT_EQ(error_of([&] { read_specimen(file); }), file + ":3: mass = 0: must be positive");
  folder.write("animal.toml", "name = 'x'\nlength = 40\n");
  EXPECT_EQ(error_of([&] { read_specimen(file); }), file + ": mass: is missing");
}

}  // namespace
}  // namespace hagfish
