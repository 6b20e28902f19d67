// The simulator for a browser: functions that a page calls in WebAssembly. A text goes in by
// live_text() and is used by the calls that follow; what comes out is read from memory. An error
// ends the instance: it is handed over as one line (live_failed), and nothing may be called after.
#include <algorithm>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include "core/input/builtin_files.hpp"
#include "core/input/input_text.hpp"
#include "core/input/toml_fault.hpp"
#include "core/knot/knot_words.hpp"
#include "core/scene/phase.hpp"
#include "experiments/live/live_run.hpp"
#include "experiments/view/drawn_obstacles.hpp"

#define EXPORTED(name) extern "C" __attribute__((export_name(#name)))
#define IMPORTED(name) extern "C" __attribute__((import_module("live"), import_name(#name)))

IMPORTED(failed) [[noreturn]] void live_failed(const char* text, std::size_t size);

namespace {

using namespace hagfish;

struct Live {
  std::string in;                      ///< the text of the next call
  std::string out;                     ///< the text of the last one
  std::string name;                    ///< of the scene, in errors
  std::string base;                    ///< its text
  std::vector<std::string> overrides;  ///< on it
  TextFiles files;
  std::unique_ptr<LiveRun> run;
  std::vector<LiveArray> animal;
  std::span<const LiveArray> frame;
};

Live live;

const char* give(std::string text) {
  live.out = std::move(text);
  return live.out.c_str();
}

ResolvedScene resolve() {
  return read_scene_source({live.base, live.name, std::nullopt}, live.overrides, live.files);
}

const LiveArray* find(std::span<const LiveArray> arrays, std::string_view name) {
  const auto found = std::ranges::find(arrays, name, &LiveArray::name);
  return found == arrays.end() ? nullptr : &*found;
}

}  // namespace

// Nothing catches: what is thrown is told and ends the instance. All that is thrown here is a
// std::exception, first among its bases.
extern "C" {
void* __cxa_allocate_exception(std::size_t size) noexcept { return std::malloc(size); }
void __cxa_free_exception(void* thrown) noexcept { std::free(thrown); }
[[noreturn]] void __cxa_throw(void* thrown, std::type_info* type, void (*)(void*)) {
  const auto& error = *static_cast<std::exception*>(thrown);
  const std::string line = toml_fault(error, *type).value_or(error.what());
  live_failed(line.data(), line.size());
}
}

/// Room for a text of `size` bytes.
EXPORTED(live_text) char* live_text(std::size_t size) {
  live.in.resize(size);
  return live.in.data();
}

/// Names of the scenes, a line each.
EXPORTED(live_scenes) const char* live_scenes() {
  std::string names;
  for (const std::string_view name : builtin_scene_names()) names += std::string(name) + "\n";
  return give(names);
}

/// A file of data/, by its name; empty where there is none.
EXPORTED(live_builtin) const char* live_builtin() {
  return give(std::string(builtin_file(live.in).value_or("")));
}

/// The names of phases in the order of their numbers, a line each.
EXPORTED(live_phases) const char* live_phases() {
  std::string names;
  for (const char* name : names_by_value(phase_table)) names += std::string(name) + "\n";
  return give(names);
}

EXPORTED(live_knot_words) const char* live_knot_words(int determinant, int v2) {
  return give(knot_words({determinant, v2}));
}

/// The scene's name, which the text is; its text by live_base, files that it names by
/// live_file_name and live_file, settings on it by live_set.
EXPORTED(live_name) void live_name() {
  live.name = live.in;
  live.files.clear();
  live.overrides.clear();
}
EXPORTED(live_base) void live_base() { live.base = live.in; }
EXPORTED(live_file_name) void live_file_name() { live.out = live.in; }
EXPORTED(live_file) void live_file() { live.files[live.out] = live.in; }
EXPORTED(live_set) void live_set() { live.overrides.push_back(live.in); }
EXPORTED(live_unset) void live_unset() { live.overrides.clear(); }

/// Starts the scene.
EXPORTED(live_start) void live_start() { live.run = std::make_unique<LiveRun>(resolve()); }
/// Goes on in the scene as it is set now.
EXPORTED(live_change) void live_change() { live.run->change(resolve()); }

/// The whole scene and its animal, as a file.
EXPORTED(live_toml) const char* live_toml() {
  const ResolvedScene& resolved = live.run->resolved();
  return give(scene_to_toml(resolved.scene, resolved.specimen));
}
EXPORTED(live_title) const char* live_title() {
  return give(printable(live.run->resolved().scene.title));
}
EXPORTED(live_specimen) const char* live_specimen() {
  return give(printable(live.run->resolved().specimen.name));
}
/// What the obstacles look like, as JSON.
EXPORTED(live_obstacles) const char* live_obstacles() {
  const ResolvedScene& resolved = live.run->resolved();
  return give(drawn_obstacles_json(resolved.scene.obstacles, resolved.model.length()));
}
EXPORTED(live_warnings) const char* live_warnings() { return give(live.run->take_warnings()); }

EXPORTED(live_advance) int live_advance(int count) { return live.run->advance(count); }
EXPORTED(live_pull)
void live_pull(int body, double x, double y, double z, double stiffness, double most) {
  live.run->pull(Pull{body, {x, y, z}, stiffness, most});
}
EXPORTED(live_let_go) void live_let_go() { live.run->pull(std::nullopt); }

/// Makes the arrays of the animal and of the frame anew.
EXPORTED(live_animal) void live_animal() { live.animal = live.run->animal(); }
EXPORTED(live_frame) void live_frame() { live.frame = live.run->frame(); }
/// The array that the text names: of the frame, or of the animal. Null where there is none.
EXPORTED(live_array) const double* live_array() {
  const LiveArray* found = find(live.frame, live.in);
  if (found == nullptr) found = find(live.animal, live.in);
  return found == nullptr ? nullptr : found->values.data();
}
EXPORTED(live_array_size) std::size_t live_array_size() {
  const LiveArray* found = find(live.frame, live.in);
  if (found == nullptr) found = find(live.animal, live.in);
  return found == nullptr ? 0 : found->values.size();
}
