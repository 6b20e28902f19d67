#include "core/input/scene_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/chain/model.hpp"
#include "core/input/basis_csv.hpp"
#include "core/input/builtin_files.hpp"
#include "core/input/curvature_csv.hpp"
#include "core/input/input_text.hpp"
#include "core/input/program_table.hpp"
#include "core/input/scene_base.hpp"
#include "core/input/scene_fields.hpp"
#include "core/input/toml_reader.hpp"
#include "core/input/toml_writer.hpp"
#include "core/knot/knot.hpp"

namespace hagfish {
namespace {

constexpr std::string_view specimen_prefix = "specimen.";

Specimen read_specimen_table(TableReader& table) {
  Specimen s;
  passive_fields(table, s);
  muscle_tissue_fields(table, s);
  table.require_all();
  specimen_fields(table, s);
  table.finish();
  for (std::size_t i = 1; i < s.station.size(); ++i) {
    if (s.station[i] <= s.station[i - 1]) {
      table.fail("station", "must rise; station " + std::to_string(i + 1) + " does not");
    }
  }
  const std::string count = std::to_string(s.station.size());
  if (s.circumference.size() != s.station.size()) {
    table.fail("circumference", "must have as many values as station, " + count);
  }
  if (s.bending_limit.size() != s.station.size()) {
    const bool radians = table.has("bending_limit_rad");
    table.fail(radians ? "bending_limit_rad" : "bending_limit_deg",
               "must have as many values as station, " + count);
  }
  if (s.bending_span > s.length) {
    table.fail("bending_span", "must not exceed the length, " + shortest(s.length));
  }
  return s;
}

/// The text of the file `name` that the scene has at the dotted `key`, and its name in errors.
std::pair<std::string, std::string> named_file(const TableReader& root, const std::string& key,
                                               const std::string& name,
                                               const std::vector<SceneSource>& sources) {
  const bool set = root.was_set(key);
  const SceneSource& source = *std::ranges::find(sources, root.file_of(key), &SceneSource::name);
  if (set || source.file) {
    std::filesystem::path file = name;
    if (!set) file = source.file->parent_path() / file;
    try {
      return {read_text_file(file), file.string()};
    } catch (const InputError& error) {
      root.fail(key, error.what());
    }
  }
  const auto text = builtin_file(name);
  if (!text) root.fail(key, "no such built-in file");
  return {std::string(*text), name + " (built in)"};
}

/// Reads `specimen` of the scene, a table or a file name, which goes to `name`.
Specimen read_scene_specimen(TableReader& root, const std::vector<SceneSource>& sources,
                             const std::vector<Override>& changes, std::string& name) {
  if (root.is_table("specimen")) {
    Specimen specimen;
    root.table("specimen", [&](TableReader& table) { specimen = read_specimen_table(table); });
    return specimen;
  }
  if (!root.has("specimen")) root.fail("specimen", "is missing: a file name or a table");
  root.string("specimen", name);
  const auto [text, file] = named_file(root, "specimen", name, sources);
  TableReader table(text, file);
  for (const auto& [key, value] : changes) {
    table.set({key.substr(specimen_prefix.size()), value}, key);
  }
  return read_specimen_table(table);
}

CurvatureProgram resolve_program(const TableReader& root, const ScriptFile& file,
                                 const std::vector<SceneSource>& sources) {
  if (file.program.empty()) return resolve_table(root, file.curvature);
  if (!file.curvature.times.empty()) {
    root.fail("script.program", "script.curvature is given too");
  }
  const auto [text, name] = named_file(root, "script.program", file.program, sources);
  return read_curvature_csv(text, name);
}

/// Reads the file of learned shapes that `basis` names, and checks shapes given in place of it.
void resolve_basis(const TableReader& root, double length, const std::vector<SceneSource>& sources,
                   ReducedBasisSettings& basis) {
  const std::string table = "controller.reduced_basis.";
  if (!basis.file.empty()) {
    if (basis.cosines > 0) root.fail(table + "file", "controller.reduced_basis.cosines is set too");
    if (!basis.stations.empty()) {
      root.fail(table + "file", "controller.reduced_basis.stations is given too");
    }
    const auto [text, name] = named_file(root, table + "file", basis.file, sources);
    read_basis_csv(text, name, length, basis);
    basis.file.clear();
  }
  const std::size_t count = basis.stations.size();
  for (std::size_t i = 1; i < count; ++i) {
    if (basis.stations[i] <= basis.stations[i - 1]) {
      root.fail_element(table + "stations", i, "must rise");
    }
  }
  const std::size_t size = basis.bend_y.size();
  if (count == 1 || (count == 0 ? size > 0 : size == 0 || size % count != 0)) {
    root.fail(table + "bend_y", "must have shapes x stations values, of two stations or more");
  }
  if (basis.bend_z.size() != size) root.fail(table + "bend_z", "must be as long as bend_y");
  if (basis.twist.size() != size) root.fail(table + "twist", "must be as long as bend_y");
}

/// Checks `file` and turns it into the script it spells, for an animal of `length` (cm).
ScriptSettings resolve_script(const TableReader& root, const ScriptFile& file, double length,
                              const std::vector<SceneSource>& sources) {
  using Kind = ScriptSettings::Kind;
  ScriptSettings script = file.settings;
  if (script.kind == Kind::none) return script;
  if (script.kind == Kind::curvature) {
    script.curvature = resolve_program(root, file, sources);
    return script;
  }
  const bool position = script.kind == Kind::position;
  if (file.unit != KnotUnit::unsaid && position == (file.unit == KnotUnit::dyn)) {
    root.fail("script.unit",
              position ? "positions are in \"L\" or \"cm\"" : "forces are in \"dyn\"");
  }
  if (file.rows.size() < 2) root.fail("script.knots", "a script needs two knots or more");
  if (file.rows[0][0] != 0) root.fail_element("script.knots", 0, "knot 1 must be at time 0");
  const bool lengths = position && file.unit != KnotUnit::cm;
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    const auto& row = file.rows[i];
    if (i > 0 && row[0] <= file.rows[i - 1][0]) {
      root.fail_element("script.knots", i,
                        "knot " + std::to_string(i + 1) + " must be later than the one before it");
    }
    script.knots.push_back({row[0], row.tail<3>() * (lengths ? length : 1)});
  }
  if (position && script.spring == 0) root.fail("script.spring", "must be positive");
  if (position && script.largest_force == 0) root.fail("script.largest_force", "must be positive");
  return script;
}

/// Standard normal (Box and Muller), from the generator's bits: the same on every platform.
double normal(std::mt19937& random) {
  const double u = (static_cast<double>(random()) + 0.5) * 0x1p-32;
  const double v = static_cast<double>(random()) * 0x1p-32;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

void draw_noise(ScriptSettings& script) {
  if (script.noise == 0) return;
  std::mt19937 random(script.noise_seed);
  for (const Eigen::Matrix3Xd& value : script.curvature.value) {
    Eigen::Matrix3Xd& noise = script.curvature.noise.emplace_back(3, value.cols());
    for (double& coordinate : noise.reshaped()) coordinate = script.noise * normal(random);
  }
  for (ScriptKnot& knot : script.knots) {
    for (double& coordinate : knot.noise) coordinate = script.noise * normal(random);
  }
}

/// The mirror image, y to -y, of all that the scene gives; applied twice, the scene itself.
void reflect(Scene& scene) {
  scene.gravity.y() *= -1;
  for (ScriptKnot& knot : scene.script.knots) {
    knot.value.y() *= -1;
    knot.noise.y() *= -1;
  }
  // Turns about x and z change sign.
  for (auto* values : {&scene.script.curvature.value, &scene.script.curvature.noise}) {
    for (Eigen::Matrix3Xd& value : *values) value.bottomRows<2>() *= -1;
  }
  for (auto* rows : {&scene.start.bend, &scene.start.bend_rate}) {
    for (Eigen::Vector4d& row : *rows) {
      row[1] *= -1;
      row[3] *= -1;
    }
  }
  scene.start.spin.x() *= -1;
  scene.start.spin.z() *= -1;
  scene.knot.mirror = !scene.knot.mirror;
  Hand& hand = scene.expect.hand;
  if (hand != Hand::any) hand = hand == Hand::right ? Hand::left : Hand::right;
}

void check_stations(const TableReader& root, const std::string& key,
                    const std::vector<Eigen::Vector4d>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double before = i == 0 ? 0 : rows[i - 1][0];
    if (rows[i][0] < before || rows[i][0] > 1 || (i > 0 && rows[i][0] == before)) {
      root.fail_element(
          key, i, "stations must rise from 0 to 1; row " + std::to_string(i + 1) + " does not");
    }
  }
}

void check_start(const TableReader& root, const ResolvedScene& resolved) {
  const StartSettings& start = resolved.scene.start;
  check_stations(root, "start.bend", start.bend);
  check_stations(root, "start.bend_rate", start.bend_rate);
  if (resolved.scene.clamp_head && !start.spin.isZero(0)) {
    root.fail("start.spin", "the head is clamped (clamp_head)");
  }
  if (!start.q.empty() && !start.bend.empty()) root.fail("start.q", "start.bend is given too");
  if (resolved.scene.mirror && (!start.q.empty() || !start.qdot.empty() || start.noise > 0)) {
    root.fail("mirror", "start.q, start.qdot and start.noise have no mirror image");
  }
  if (!start.qdot.empty() && (!start.bend_rate.empty() || !start.spin.isZero(0))) {
    root.fail("start.qdot", "start.bend_rate or start.spin is given too");
  }
  if (start.q.empty() && start.qdot.empty()) return;
  const Model model = make_hagfish(resolved.specimen, resolved.scene);
  const auto check_length = [&](const std::string& key, const std::vector<double>& x, int length) {
    if (!x.empty() && static_cast<int>(x.size()) != length) {
      root.fail(key, "has " + std::to_string(x.size()) + " numbers; " +
                         std::to_string(model.body_count()) + " bodies need " +
                         std::to_string(length));
    }
  };
  check_length("start.q", start.q, model.nq());
  check_length("start.qdot", start.qdot, model.nv());
  if (!start.q.empty() && Eigen::Vector4d::Map(start.q.data() + 3).isZero(0)) {
    root.fail("start.q", "numbers 4 to 7 are a quaternion and must not all be 0");
  }
}

void check_passive(const TableReader& root, const ResolvedScene& resolved) {
  const Specimen& s = resolved.specimen;
  const std::size_t count = s.station.size();
  for (const auto& [key, values] : {std::pair("bending_stiffness", &s.bending_stiffness),
                                    {"bending_damping", &s.bending_damping},
                                    {"twist_stiffness", &s.twist_stiffness},
                                    {"twist_damping", &s.twist_damping}}) {
    if (!values->empty() && values->size() != count) {
      root.fail("specimen", "its passive." + std::string(key) +
                                " must have as many values as station, " + std::to_string(count));
    }
    if (values->empty() && resolved.scene.model.passive == PassiveSource::specimen) {
      root.fail("model.passive", "the specimen has no passive." + std::string(key));
    }
  }
}

void check_active(const TableReader& root, const Scene& scene) {
  if (scene.script.kind != ScriptSettings::Kind::curvature) return;
  const ActiveSettings& active = scene.active;
  for (const auto& [key, value] : {std::pair("active.stiffness", active.stiffness),
                                   {"active.tone_time", active.tone_time},
                                   {"active.relax_time", active.relax_time},
                                   {"active.capacity", active.capacity}}) {
    if (value == 0) root.fail(key, "must be positive where a curvature program bends the animal");
  }
  const double end = scene.script.curvature.time.back();
  if (end < scene.controller.tighten_from) {
    root.fail("controller.tighten_from",
              "the curvature program ends before, at " + shortest(end) + " s");
  }
}

void check_muscles(const TableReader& root, const ResolvedScene& resolved) {
  const MuscleSettings& settings = resolved.scene.muscle;
  const MuscleTissue& tissue = resolved.specimen.muscle;
  const std::size_t count = resolved.specimen.station.size();
  for (const auto& [key, area] : {std::pair("longitudinal_area", &tissue.longitudinal_area),
                                  {"oblique_area", &tissue.oblique_area}}) {
    if (!area->empty() && area->size() != count) {
      root.fail("specimen", "its muscle." + std::string(key) +
                                " must have as many values as station, " + std::to_string(count));
    }
    if (settings.present && area->empty()) {
      root.fail("muscle.present", "the specimen has no muscle." + std::string(key));
    }
  }
  for (const auto& [key, value] : {std::pair("stress", tissue.stress),
                                   {"radius_share", tissue.radius_share},
                                   {"oblique_angle", tissue.oblique_angle}}) {
    if (settings.present && value == 0) {
      root.fail("muscle.present",
                "the specimen's muscle." + std::string(key) + " is 0 or missing, must be positive");
    }
  }
  if (resolved.scene.controller.law != LawName::muscles) return;
  if (!settings.present) {
    root.fail("muscle.present", "must be true where controller.law = \"muscles\"");
  }
  if (settings.activation_time == 0) {
    root.fail("muscle.activation_time", "must be positive where controller.law = \"muscles\"");
  }
}

void check_law(const TableReader& root, const ControllerSettings& controller) {
  if (controller.law != LawName::knot_speed) return;
  const KnotSpeedSettings& loop = controller.knot_speed;
  for (const auto& [key, value] :
       {std::pair("target", loop.target), {"gain", loop.gain}, {"filter", loop.filter}}) {
    if (value == 0) {
      root.fail("controller.knot_speed." + std::string(key),
                "must be positive where controller.law = \"knot_speed\"");
    }
  }
}

void check_basis(const TableReader& root, const ControllerSettings& controller) {
  if (controller.law != LawName::reduced_basis) return;
  const ReducedBasisSettings& basis = controller.reduced_basis;
  const std::string table = "controller.reduced_basis.";
  const std::string where = " where controller.law = \"reduced_basis\"";
  if ((basis.cosines > 0) != basis.stations.empty()) {
    root.fail(table + "cosines", "must be positive, or shapes be given by file, not both," + where);
  }
  if (basis.most == 0) root.fail(table + "most", "must be positive" + where);
  if (basis.places.empty()) {
    for (const auto& [key, value] :
         {std::pair("period", basis.period), {"softness", basis.softness}}) {
      if (value == 0) root.fail(table + key, "must be positive" + where);
    }
    if (!basis.played.empty()) root.fail(table + "played", "has no places");
    return;
  }
  for (std::size_t i = 1; i < basis.places.size(); ++i) {
    if (basis.places[i] <= basis.places[i - 1]) {
      root.fail_element(table + "places", i, "must rise");
    }
  }
  const std::size_t size = basis.places.size() * static_cast<std::size_t>(basis_size(basis));
  if (basis.places.size() < 2 || basis.played.size() != size) {
    root.fail(table + "played", "must have places x shapes values, " + std::to_string(size) +
                                    ", of two places or more");
  }
}

void check_food(const TableReader& root, const Scene& scene) {
  const FoodSettings& food = scene.food;
  if (food.hold == 0) return;
  const Phase free_from = scene.controller.free_from;
  if (!scene.clamp_head)
    root.fail("food.hold", "no food holds a head that is not clamped (clamp_head)");
  if (phase_order(free_from) <= phase_order(Phase::pull)) {
    root.fail("food.hold", "no food holds a head that is free from \"" +
                               std::string(phase_name(free_from)) + "\" on (controller.free_from)");
  }
  if (!scene.wall.present) {
    root.fail("food.hold", "without a head plate (wall.present) the knot presses against nothing");
  }
  if (scene.controller.leave_by == BodyEnd::tail) {
    root.fail("food.hold", "a knot that pulls cannot turn back (controller.leave_by)");
  }
  if (food.cap.from == 0) root.fail("food.cap.from", "must be positive where there is food");
  if (food.cap.to < food.cap.from) {
    root.fail("food.cap.to", "must not be less than food.cap.from, " + shortest(food.cap.from));
  }
}

void check_times(const TableReader& root, const TimeSettings& time) {
  const std::string step = "must not be less than time.step, " + shortest(time.step);
  if (time.frame_interval < time.step) root.fail("time.frame_interval", step);
  if (time.duration < time.step) root.fail("time.duration", step);
  // A frame or a run of more than 1e9 steps is taken for an error.
  const double steps = time.frame_interval / time.step;
  if (steps > 1e9 || std::abs(steps - std::round(steps)) > 1e-9 * steps) {
    root.fail("time.frame_interval", "must be a whole number of time.step, " + shortest(time.step));
  }
  if (time.duration / time.step > 1e9) {
    root.fail("time.duration", "must be at most 1e9 times time.step, " + shortest(time.step));
  }
}

/// Whether two times follow each other, as far as that can be said before the run.
bool in_order(const RunTime& a, const RunTime& b) {
  if (a.after && b.after) {
    const int first = phase_order(*a.after), second = phase_order(*b.after);
    return first < second || (first == second && a.time <= b.time);
  }
  return a.after || b.after || a.time <= b.time;
}

void check_expectations(const TableReader& root, const Scene& scene) {
  const auto known = [](const std::string& name) { return knot_called(name).has_value(); };
  const std::string names = "must be the name of a knot, 3_1 to 7_7 or det=D,v2=V";
  if (!scene.expect.knot.empty() && (!known(scene.expect.knot) || scene.expect.knot == "0_1")) {
    root.fail("expect.knot", names + ", or empty for none");
  }
  const std::vector<KnotStretch>& types = scene.expect.types;
  for (std::size_t i = 0; i < types.size(); ++i) {
    if (!known(types[i].type)) {
      root.fail_element("expect.types", i, "type " + names + ", or 0_1 for none");
    }
    if (std::isnan(types[i].from.time) || std::isnan(types[i].to.time)) {
      root.fail_element("expect.types", i,
                        "a time must be in s, a phase as in \"release\", later as in "
                        "\"free + 0.5\", or \"end\"");
    }
    const RunTime start;
    if (!in_order(types[i].from, types[i].to) ||
        !in_order(i > 0 ? types[i - 1].to : start, types[i].from)) {
      root.fail_element("expect.types", i, "times must rise");
    }
  }
  if (scene.controller.contact_gap > scene.contact.margin) {
    root.fail("controller.contact_gap",
              "must not exceed contact.margin, " + shortest(scene.contact.margin));
  }
}

ResolvedScene read(SceneSource source, const std::vector<std::string>& overrides) {
  const std::string name = source.name;
  std::vector<SceneSource> sources;
  TableReader root = read_with_bases(std::move(source), sources);
  std::vector<Override> specimen_changes;
  for (const auto& assignment : overrides) {
    const Override change = parse_override(assignment);
    if ((change.key + ".").starts_with("base.")) {
      throw_input_error(name + ": --set " + shortened(assignment) + ": only a file has a base");
    }
    if (change.key.starts_with(specimen_prefix)) {
      specimen_changes.push_back(change);
    } else {
      root.set(change, change.key);
    }
  }
  // The scene's own table if it has one; else the file that it names.
  if (root.is_table("specimen")) {
    for (const auto& change : specimen_changes) root.set(change, change.key);
  }
  ResolvedScene result;
  ScriptFile script;
  result.specimen = read_scene_specimen(root, sources, specimen_changes, result.scene.specimen);
  root.set_body(result.specimen.length, mean_diameter(result.specimen));
  scene_fields(root, result.scene, script);
  root.finish();
  result.scene.script = resolve_script(root, script, result.specimen.length, sources);
  draw_noise(result.scene.script);
  resolve_basis(root, result.specimen.length, sources, result.scene.controller.reduced_basis);
  if (result.scene.mirror) reflect(result.scene);
  check_start(root, result);
  check_passive(root, result);
  check_active(root, result.scene);
  check_muscles(root, result);
  check_law(root, result.scene.controller);
  check_basis(root, result.scene.controller);
  check_food(root, result.scene);
  check_times(root, result.scene.time);
  check_expectations(root, result.scene);
  return result;
}

}  // namespace

Specimen read_specimen(const std::filesystem::path& file) {
  TableReader table(read_text_file(file), file.string());
  return read_specimen_table(table);
}

ResolvedScene read_scene(const std::filesystem::path& file,
                         const std::vector<std::string>& overrides) {
  return read({read_text_file(file), file.string(), file}, overrides);
}

ResolvedScene read_scene_text(const std::string& text, const std::string& name,
                              const std::vector<std::string>& overrides) {
  return read({text, name, std::nullopt}, overrides);
}

std::string scene_to_toml(const Scene& scene, const Specimen& specimen) {
  using Kind = ScriptSettings::Kind;
  Scene fields = scene;  // the writer only reads them
  if (scene.mirror) reflect(fields);
  Specimen animal = specimen;
  ScriptFile script;
  script.settings = fields.script;
  // Positions in cm, as they are in memory: a division by the length would not undo to the bit.
  script.unit = scene.script.kind == Kind::position ? KnotUnit::cm : KnotUnit::dyn;
  for (const auto& knot : fields.script.knots) {
    script.rows.emplace_back(knot.time, knot.value.x(), knot.value.y(), knot.value.z());
  }
  script.curvature = program_table(fields.script.curvature);
  TomlWriter writer;
  scene_fields(writer, fields, script);
  writer.table("specimen", [&](TomlWriter& table) {
    specimen_fields(table, animal);
    passive_fields(table, animal);
    if (!animal.muscle.longitudinal_area.empty()) muscle_tissue_fields(table, animal);
  });
  return writer.text();
}

}  // namespace hagfish
