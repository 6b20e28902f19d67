#include "experiments/design/tries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>

namespace hagfish {
namespace {

constexpr std::size_t kept_of_type = 40;
constexpr double random_share = 0.25;
constexpr double displaced_share = 0.5;  // once the wanted type was tied
// s after a type was first seen, up to which its path is kept: the next waypoints are behind that.
constexpr double going_on = 0.4;
constexpr std::size_t most_waypoints = 100;  // of a part, in a file that is whole
constexpr const char* failed_word = "failed";

std::pair<int, int> key(const KnotInvariants& type) { return {type.determinant, type.v2}; }

/// Of the type, or of the composite, as its name says; many of a type without a name.
int crossings_of(const std::string& name) {
  if (const std::size_t sum = name.find('#'); sum != std::string::npos) {
    const std::size_t second = name.find_first_of("0123456789", sum);
    return crossings_of(name.substr(0, sum)) + crossings_of(name.substr(second));
  }
  constexpr int many = 100;
  const bool named = name.size() > 1 && name[1] == '_';
  return named ? name[0] - '0' : many;
}

void keep(int number, const TailPath& path, std::vector<TailPath>& paths) {
  if (paths.size() < kept_of_type) {
    paths.push_back(path);
  } else {
    paths[static_cast<std::size_t>(number) % kept_of_type] = path;
  }
}

/// What tying_text() has behind how the run ended; false where it is not whole.
bool read_path(std::istream& words, TailPath& path) {
  for (auto* part : {&path.swing, &path.turns, &path.pull}) {
    std::size_t count = 0;
    if (!(words >> count) || count > most_waypoints) return false;
    part->resize(count);
    for (TailPath::Waypoint& at : *part) {
      words >> at.time >> at.place.x() >> at.place.y() >> at.place.z();
    }
  }
  std::string end;
  return words >> end && end == ".";
}

const TailPath& one_of(const std::vector<TailPath>& paths, Draw& draw) {
  return paths[draw.below(static_cast<int>(paths.size()))];
}

}  // namespace

Archive::Archive(unsigned seed, const std::string& wanted)
    : seed_(seed),
      wanted_(*knot_called(*name_in_scene(wanted))),
      crossings_(crossings_of(wanted)) {}

PathPlan Archive::plan_of(int number) const {
  Draw draw(seed_, static_cast<unsigned>(number));
  if (!tied_.empty() && draw.chance(displaced_share)) {
    return {displaced_path(one_of(tied_, draw), draw), {}};
  }
  if (paths_.empty() || draw.chance(random_share)) return random_plan(draw);
  const auto type = std::next(paths_.begin(), draw.below(static_cast<int>(paths_.size())));
  return further_plan(one_of(type->second, draw), draw);
}

void Archive::add(int number, const Tying& tying) {
  const KnotInvariants none;
  std::set<Type> seen_here;
  for (const TypeSeen& seen : tying.seen) {
    if (seen.to == seen.from) continue;
    seen_here.insert(key(seen.type));
    if (seen.type == none || crossings_of(knot_name(seen.type)) > crossings_) continue;
    keep(number, path_until(tying.path, seen.from + going_on), paths_[key(seen.type)]);
  }
  for (const Type& type : seen_here) ++counts_[type];
  if (tying.tied() == wanted_) keep(number, tying.path, tied_);
}

std::string tying_text(const Tying& tying) {
  std::string text;
  for (const TypeSeen& seen : tying.seen) {
    text += fmt::format("{}{} {:.17g} {:.17g}", text.empty() ? "" : " ", knot_name(seen.type),
                        seen.from, seen.to);
  }
  text += tying.failed ? std::string(" ") + failed_word : " .";
  for (const auto* part : {&tying.path.swing, &tying.path.turns, &tying.path.pull}) {
    text += fmt::format(" {}", part->size());
    for (const TailPath::Waypoint& at : *part) {
      text += fmt::format(" {:.17g} {:.17g} {:.17g} {:.17g}", at.time, at.place.x(), at.place.y(),
                          at.place.z());
    }
  }
  return text + " .";
}

std::optional<Tying> tying_of(const std::string& text) {
  std::istringstream words(text);
  Tying tying;
  std::string name;
  while (words >> name) {
    if (name == "." || name == failed_word) {
      tying.failed = name == failed_word;
      if (tying.seen.empty() || !read_path(words, tying.path)) return std::nullopt;
      return tying;
    }
    const std::optional<KnotInvariants> type = knot_called(name);
    TypeSeen seen;
    if (!type || !(words >> seen.from >> seen.to)) return std::nullopt;
    seen.type = *type;
    tying.seen.push_back(seen);
  }
  return std::nullopt;
}

}  // namespace hagfish
