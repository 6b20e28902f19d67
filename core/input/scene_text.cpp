#include "core/input/scene_text.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <random>

#include "core/input/builtin_files.hpp"
#include "core/input/csv/basis_csv.hpp"
#include "core/input/csv/curvature_csv.hpp"
#include "core/input/csv/program_table.hpp"
#include "core/input/input_text.hpp"
#include "core/input/scene_fields.hpp"
#include "core/input/scene_parts.hpp"
#include "core/input/toml/toml_reader.hpp"
#include "core/input/toml/toml_writer.hpp"
#include "core/scene/normal_draw.hpp"

namespace hagfish {
namespace {

constexpr std::string_view specimen_prefix = "specimen.";

/// Where the files that a scene names are looked for.
struct Sources {
  std::vector<SceneSource> scenes;  ///< the scene, and each its base
  const TextFiles& files;
  const FileAccess* access;
};

Specimen read_specimen_table(TableReader& table) {
  Specimen s;
  passive_fields(table, s);
  muscle_tissue_fields(table, s);
  flesh_tissue_fields(table, s);
  table.require_all();
  specimen_fields(table, s);
  table.finish();
  for (std::size_t i = 1; i < s.station.size(); ++i) {
    if (s.station[i] <= s.station[i - 1]) {
      table.fail("station", "must rise; station " + std::to_string(i + 1) + " does not");
    }
  }
  const std::size_t count = s.station.size();
  const bool radians = table.has("bending_limit_rad");
  for (const auto& [key, values] :
       {std::pair("circumference", &s.circumference),
        {radians ? "bending_limit_rad" : "bending_limit_deg", &s.bending_limit},
        {"passive.bending_stiffness", &s.bending_stiffness},
        {"passive.bending_damping", &s.bending_damping},
        {"passive.twist_stiffness", &s.twist_stiffness},
        {"passive.twist_damping", &s.twist_damping},
        {"muscle.longitudinal_area", &s.muscle.longitudinal_area},
        {"muscle.oblique_area", &s.muscle.oblique_area}}) {
    if (!values->empty() && values->size() != count) {
      table.fail(key, "must have as many values as station, " + std::to_string(count));
    }
  }
  if (s.bending_span > s.length) {
    table.fail("bending_span", "must not exceed the length, " + shortest(s.length) + " cm");
  }
  return s;
}

/// The text of the file `name` that the scene has at the dotted `key`, and its name in errors.
std::pair<std::string, std::string> named_file(const TableReader& root, const std::string& key,
                                               const std::string& name, const Sources& sources) {
  const bool set = root.was_set(key);
  if (const auto text = sources.files.find(name); text != sources.files.end()) {
    return {text->second, name};
  }
  const SceneSource& source =
      *std::ranges::find(sources.scenes, root.file_of(key), &SceneSource::name);
  if (sources.access != nullptr && (set || source.file)) {
    try {
      SceneSource file = sources.access->read(name, set ? std::nullopt : source.file);
      return {std::move(file.text), std::move(file.name)};
    } catch (const InputError& error) {
      root.fail(key, error.what());
    }
  }
  const auto text = builtin_file(name);
  if (!text) root.fail(key, "no such built-in file");
  return {std::string(*text), name + " (built in)"};
}

/// Reads `specimen` of the scene, a table or a file name, which goes to `name`.
Specimen read_scene_specimen(TableReader& root, const Sources& sources,
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
  table.read_units();
  for (const auto& [key, value] : changes) {
    table.set({key.substr(specimen_prefix.size()), value}, key);
  }
  return read_specimen_table(table);
}

CurvatureProgram resolve_program(const TableReader& root, const ScriptFile& file,
                                 const Sources& sources) {
  if (file.program.empty()) return resolve_table(root, file.curvature);
  if (!file.curvature.times.empty()) {
    root.fail("script.program", "script.curvature is also given; give only one");
  }
  const auto [text, name] = named_file(root, "script.program", file.program, sources);
  return read_curvature_csv(text, name);
}

/// Reads the file of learned shapes that `basis` names, and checks shapes given in place of it.
void resolve_basis(const TableReader& root, double length, const Sources& sources,
                   ReducedBasisSettings& basis) {
  const std::string table = "controller.reduced_basis.";
  if (!basis.file.empty()) {
    if (basis.cosines > 0)
      root.fail(table + "file", "controller.reduced_basis.cosines is also given; give only one");
    if (!basis.stations.empty()) {
      root.fail(table + "file", "controller.reduced_basis.stations is also given; give only one");
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

/// One of the unit of the waypoints of `file`, dyn or cm, for an animal of `length` (cm).
double waypoint_size(const TableReader& root, const ScriptFile& file, double length) {
  const bool position = file.settings.kind == ScriptSettings::Kind::position;
  const bool force = file.unit == WaypointUnit::dyn || file.unit == WaypointUnit::newton;
  if (file.unit != WaypointUnit::unsaid && position == force) {
    root.fail("script.unit",
              position ? R"(positions are in "L", "cm" or "m")" : R"(forces are in "dyn" or "N")");
  }
  switch (file.unit) {
    case WaypointUnit::unsaid:
      return position ? length : root.in_si("script.knots") ? 1e5 : 1;
    case WaypointUnit::newton:
      return 1e5;
    case WaypointUnit::metre:
      return 1e2;
    case WaypointUnit::body_length:
      return length;
    case WaypointUnit::dyn:
    case WaypointUnit::cm:
      break;
  }
  return 1;
}

/// Checks `file` and turns it into the script it spells, for an animal of `length` (cm).
ScriptSettings resolve_script(const TableReader& root, const ScriptFile& file, double length,
                              const Sources& sources) {
  using Kind = ScriptSettings::Kind;
  ScriptSettings script = file.settings;
  if (script.kind == Kind::none) return script;
  if (script.kind == Kind::curvature) {
    script.curvature = resolve_program(root, file, sources);
    return script;
  }
  const bool position = script.kind == Kind::position;
  const double unit = waypoint_size(root, file, length);
  if (file.rows.size() < 2) root.fail("script.knots", "a script needs two knots or more");
  if (file.rows[0][0] != 0) root.fail_element("script.knots", 0, "knot 1 must be at time 0");
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    const auto& row = file.rows[i];
    if (i > 0 && row[0] <= file.rows[i - 1][0]) {
      root.fail_element("script.knots", i,
                        "knot " + std::to_string(i + 1) + " must be later than the one before it");
    }
    script.waypoints.push_back({row[0], row.tail<3>() * unit});
  }
  if (position && script.spring == 0) root.fail("script.spring", "must be positive");
  if (position && script.largest_force == 0) root.fail("script.largest_force", "must be positive");
  return script;
}

/// A unit vector along `v`; one that is read again stays as it is to the last bit.
Eigen::Vector3d unit(const TableReader& root, std::size_t index, const char* key,
                     const Eigen::Vector3d& v) {
  constexpr double rounding = 1e-12;
  const double norm = v.stableNorm();
  if (norm == 0) root.fail_element("obstacle", index, std::string(key) + " must not be all 0");
  return std::abs(norm - 1) <= rounding ? v : Eigen::Vector3d(v / norm);
}

/// The closed strand round a hole of `ring.inner_radius`.
void close_ring(const TableReader& root, std::size_t index, ObstacleFile& ring) {
  constexpr int points = 32;  // the spline through them is round to 4e-5 of its radius
  const Eigen::Vector3d axis = unit(root, index, "axis", ring.axis);
  const Eigen::Vector3d across = axis.unitOrthogonal();
  const double radius = ring.inner_radius + ring.strand.radius;
  for (int k = 0; k < points; ++k) {
    const double turn = 2 * std::numbers::pi * k / points;
    ring.strand.points.emplace_back(
        ring.centre + radius * (std::cos(turn) * across + std::sin(turn) * axis.cross(across)));
  }
  ring.strand.closed = true;
}

/// Checks what `files` spell and turns it into obstacles, for an animal that passes a hole of more
/// than the radius `narrowest` (cm).
std::vector<Obstacle> resolve_obstacles(const TableReader& root, std::vector<ObstacleFile>& files,
                                        double narrowest) {
  using Kind = ObstacleFile::Kind;
  constexpr std::size_t longest_name = 40;
  constexpr std::size_t most_points = 2000;
  std::size_t points = 0;
  std::vector<Obstacle> obstacles;
  for (std::size_t i = 0; i < files.size(); ++i) {
    ObstacleFile& file = files[i];
    const auto fail = [&](const std::string& why) { root.fail_element("obstacle", i, why); };
    if (file.name.empty()) file.name = "obstacle " + std::to_string(i + 1);
    const auto allowed = [](unsigned char c) {
      return std::isalnum(c) != 0 || c == ' ' || c == '_' || c == '-';
    };
    if (file.name.size() > longest_name || !std::ranges::all_of(file.name, allowed)) {
      fail("name must be at most 40 letters, digits, spaces, _ and -");
    }
    if (file.kind == Kind::plane) {
      file.plane.normal = unit(root, i, "normal", file.plane.normal);
      obstacles.push_back({file.name, file.plane});
      continue;
    }
    if (file.kind == Kind::ring) {
      if (file.inner_radius <= narrowest) {
        fail("inner_radius = " + shortest(file.inner_radius) +
             " cm: the hole is too narrow for the body, whose radius is " + shortest(narrowest) +
             " cm");
      }
      close_ring(root, i, file);
    }
    const auto& [through, _, closed] = file.strand;
    const std::size_t count = through.size();
    points += count;
    if (points > most_points) fail("points: all strands together may have at most 2000");
    if (closed && count < 3) fail("points: a closed strand needs three or more");
    for (std::size_t k = closed ? 0 : 1; k < count; ++k) {
      if (through[k] == through[(k + count - 1) % count]) {
        fail("points: point " + std::to_string(k + 1) + " is the same as the last one");
      }
    }
    obstacles.push_back({file.name, file.strand});
  }
  return obstacles;
}

void draw_noise(ScriptSettings& script) {
  if (script.noise == 0) return;
  std::mt19937 random(script.noise_seed);
  for (const Eigen::Matrix3Xd& value : script.curvature.value) {
    Eigen::Matrix3Xd& noise = script.curvature.noise.emplace_back(3, value.cols());
    for (double& coordinate : noise.reshaped()) coordinate = script.noise * normal_draw(random);
  }
  for (Waypoint& waypoint : script.waypoints) {
    for (double& coordinate : waypoint.noise) coordinate = script.noise * normal_draw(random);
  }
}

/// The mirror image, y to -y, of all that the scene gives; applied twice, the scene itself.
void reflect(Scene& scene) {
  scene.gravity.y() *= -1;
  for (Waypoint& waypoint : scene.script.waypoints) {
    waypoint.value.y() *= -1;
    waypoint.noise.y() *= -1;
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
  for (Obstacle& obstacle : scene.obstacles) {
    if (auto* plane = std::get_if<Plane>(&obstacle.shape)) {
      plane->point.y() *= -1;
      plane->normal.y() *= -1;
    } else if (auto* strand = std::get_if<Strand>(&obstacle.shape)) {
      for (Eigen::Vector3d& point : strand->points) point.y() *= -1;
    }
  }
  scene.start.spin.x() *= -1;
  scene.start.spin.z() *= -1;
  scene.knot.mirror = !scene.knot.mirror;
  Hand& hand = scene.expect.hand;
  if (hand != Hand::any) hand = hand == Hand::right ? Hand::left : Hand::right;
}

}  // namespace

ResolvedScene read_scene_source(const SceneSource& source,
                                const std::vector<std::string>& overrides, const TextFiles& files,
                                const FileAccess* access) {
  const std::string& name = source.name;
  Sources sources{{}, files, access};
  TableReader root = read_with_bases(source, sources.scenes, access);
  std::vector<Override> specimen_changes;
  for (const auto& assignment : overrides) {
    const Override change = parse_override(assignment);
    const auto refuse = [&](const char* why) {
      throw_input_error(name + ": --set " + shortened(assignment) + ": " + why);
    };
    if ((change.key + ".").starts_with("base.")) refuse("only a file has a base");
    if (change.key == "units" || change.key == "specimen.units") refuse("only a file has units");
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
  std::vector<ObstacleFile> obstacles;
  scene_fields(root, result.scene, script, obstacles);
  root.finish();
  result.scene.script = resolve_script(root, script, result.specimen.length, sources);
  draw_noise(result.scene.script);
  // In a round hole a section of flesh keeps the area of the hole.
  const double share =
      result.scene.flesh.present() ? std::sqrt(result.specimen.flesh.least_area) : 1;
  result.scene.obstacles = resolve_obstacles(
      root, obstacles,
      share * std::ranges::max(result.specimen.circumference) / (2 * std::numbers::pi));
  resolve_basis(root, result.specimen.length, sources, result.scene.controller.reduced_basis);
  if (result.scene.mirror) reflect(result.scene);
  check_scene(root, result);
  return result;
}

Specimen read_specimen_text(const std::string& text, const std::string& name) {
  TableReader table(text, name);
  table.read_units();
  return read_specimen_table(table);
}

std::string scene_to_toml(const Scene& scene, const Specimen& specimen) {
  using Kind = ScriptSettings::Kind;
  Scene fields = scene;  // the writer only reads them
  if (scene.mirror) reflect(fields);
  Specimen animal = specimen;
  ScriptFile script;
  script.settings = fields.script;
  // Positions in cm, as they are in memory: a division by the length would not undo to the bit.
  script.unit = scene.script.kind == Kind::position ? WaypointUnit::cm : WaypointUnit::dyn;
  for (const auto& [time, value, _] : fields.script.waypoints) {
    script.rows.emplace_back(time, value.x(), value.y(), value.z());
  }
  script.curvature = program_table(fields.script.curvature);
  std::vector<ObstacleFile> obstacles;
  for (const Obstacle& one : fields.obstacles) {
    ObstacleFile& file = obstacles.emplace_back();
    file.name = one.name;
    if (const Plane* plane = one.plane()) file.plane = *plane;
    if (const Strand* strand = one.strand()) {
      file.kind = ObstacleFile::Kind::strand;
      file.strand = *strand;
    }
  }
  TomlWriter writer;
  writer.string("units", "CGS");
  scene_fields(writer, fields, script, obstacles);
  writer.table("specimen", [&](TomlWriter& table) {
    specimen_fields(table, animal);
    passive_fields(table, animal);
    if (!animal.muscle.longitudinal_area.empty()) muscle_tissue_fields(table, animal);
    if (animal.flesh.least_area > 0 || !animal.flesh.stiffness_range.empty()) {
      flesh_tissue_fields(table, animal);
    }
  });
  return writer.text();
}

}  // namespace hagfish
