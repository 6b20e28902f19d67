#include "experiments/common/idle_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/input/input_error.hpp"
#include "core/input/scene_fields.hpp"

namespace hagfish {
namespace {

/// A key of a field or a table that does not act everywhere.
struct Field {
  std::string key;  ///< dotted
  Acts acts;
};

/// Visits the fields of a scene as TableReader does, and keeps those that do not act everywhere.
class FieldVisitor {
 public:
  std::vector<Field> found;

  void require(std::string_view) {}
  void only_cgs(std::initializer_list<std::string_view>) {}
  // Keys that are plain texts act everywhere.
  void see(std::string_view) {}
  void see(const ActingKey& key) { found.push_back({path_ + std::string(key), key.acts}); }
  void string(const auto& key, const auto&...) { see(key); }
  void boolean(const auto& key, const auto&...) { see(key); }
  void integer(const auto& key, const auto&...) { see(key); }
  void number(const auto& key, const auto&...) { see(key); }
  void length(const auto& key, const auto&...) { see(key); }
  void numbers(const auto& key, const auto&...) { see(key); }
  void rows(const auto& key, const auto&...) { see(key); }
  void text_rows(const auto& key, const auto&...) { see(key); }
  void vector(const auto& key, const auto&...) { see(key); }
  void place(const auto& key, const auto&...) { see(key); }
  void places(const auto& key, const auto&...) { see(key); }
  void angle(std::string_view, const auto&...) {}
  void tables(std::string_view, const auto&...) {}
  template <class E>
  void choice(const auto& key, const E&, const Choices<E>&) {
    see(key);
  }
  void table(const auto& key, const auto& visit) {
    see(key);
    const std::string outside = path_;
    path_ += std::string(key) + ".";
    visit(*this);
    path_ = outside;
  }

 private:
  std::string path_;
};

std::vector<Field> fields_of(Scene scene) {
  FieldVisitor visitor;
  ScriptFile script;
  script.settings = scene.script;
  std::vector<ObstacleFile> obstacles;
  scene_fields(visitor, scene, script, obstacles);
  return visitor.found;
}

/// The keys of KEY=VALUE texts.
std::vector<std::string> keys_of(const std::vector<std::string>& set) {
  std::vector<std::string> keys;
  for (const std::string& one : set) {
    std::string key = one.substr(0, one.find('='));
    std::erase(key, ' ');
    keys.push_back(key);
  }
  return keys;
}

/// Whether `key` is `of` or within it.
bool concerns(const std::string& key, const std::string& of) {
  return key == of || key.starts_with(of + ".");
}

/// Why nothing reads `key` in any of `scenes`; empty where something may. One reason must hold in
/// all of them: two scenes may each lack one of two things that the key needs, and a third have
/// both.
std::string why_idle(std::span<const Scene> scenes, const std::string& key) {
  for (const Field& field : fields_of(scenes.front())) {
    const auto same = [&field](const Field& other) {
      return other.key == field.key && !other.acts.here && other.acts.unless == field.acts.unless;
    };
    if (concerns(key, field.key) && std::ranges::all_of(scenes, [&](const Scene& scene) {
          return std::ranges::any_of(fields_of(scene), same);
        })) {
      return field.acts.unless;
    }
  }
  return "";
}

/// Refuses the first of `set` that is idle in all of `scenes`.
void refuse_idle(std::span<const Scene> scenes, const std::vector<std::string>& set,
                 const char* option, const char* where) {
  for (const std::string& key : keys_of(set)) {
    if (const std::string why = why_idle(scenes, key); !why.empty()) {
      throw InputError(fmt::format("{}{}: has no effect {}: {}", option, key, where, why));
    }
  }
}

}  // namespace

void require_settings_act(const Scene& scene, const std::vector<std::string>& set) {
  refuse_idle({&scene, 1}, set, "--set ", "here");
}

void require_settings_act_somewhere(const std::vector<Scene>& scenes,
                                    const std::vector<std::string>& set) {
  refuse_idle(scenes, set, "", "in any cell");
}

void require_settings_act_from(const Simulation& sim, const Scene& scene,
                               const std::vector<std::string>& set) {
  require_settings_act(scene, set);
  const Phase now = sim.controller.phase;
  for (const std::string& key : keys_of(set)) {
    if (concerns(key, "start")) {
      throw InputError(
          fmt::format("--set {}: has no effect here: the branch begins where its log stands", key));
    }
    for (const auto& [of, acts] : fields_of(scene)) {
      if (concerns(key, of) && acts.until && phase_order(now) > phase_order(*acts.until)) {
        throw InputError(fmt::format("--set {}: has no effect here: the branch begins in phase {}",
                                     key, phase_name(now)));
      }
    }
  }
}

}  // namespace hagfish
