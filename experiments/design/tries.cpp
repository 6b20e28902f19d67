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
constexpr double displaced_share = 0.5;      // once the wanted type was tied
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

template <class Path>
void keep(int number, const Path& path, std::vector<Path>& paths) {
  if (paths.size() < kept_of_type) {
    paths.push_back(path);
  } else {
    paths[static_cast<std::size_t>(number) % kept_of_type] = path;
  }
}

template <class Path>
const Path& one_of(const std::vector<Path>& paths, Draw& draw) {
  return paths[draw.below(static_cast<int>(paths.size()))];
}

bool same(const TailPath& a, const TailPath& b) {
  const auto equal = [](const TailPath::Waypoint& at, const TailPath::Waypoint& other) {
    return at.time == other.time && at.place == other.place;
  };
  return std::ranges::equal(a.swing, b.swing, equal) && std::ranges::equal(a.turns, b.turns, equal);
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

}  // namespace

Archive::Archive(unsigned seed, const std::string& wanted)
    : seed_(seed),
      wanted_(*knot_called(*name_in_scene(wanted))),
      crossings_(crossings_of(wanted)) {}

PathPlan Archive::plan_of(int number) const {
  Draw draw(seed_, static_cast<unsigned>(number));
  const std::vector<TailPath>& with_pull = tied_.empty() ? lost_ : tied_;
  if (!with_pull.empty() && draw.chance(displaced_share)) {
    return {displaced_path(one_of(with_pull, draw), draw), {}, {}};
  }
  if (paths_.empty() || draw.chance(random_share)) return random_plan(draw);
  const auto type = std::next(paths_.begin(), draw.below(static_cast<int>(paths_.size())));
  const PathPlan& from = one_of(type->second, draw);
  if (draw.chance(0.3)) return further_plan(displaced_path(from.path, draw), draw);
  PathPlan plan = further_plan(from.path, draw);
  plan.reached = from.reached;
  return plan;
}

void Archive::add(int number, const Tying& tying) {
  const KnotInvariants none;
  std::set<Type> seen_here;
  for (const TypeSeen& seen : tying.seen) {
    if (seen.to == seen.from) continue;
    seen_here.insert(key(seen.type));
    if (seen.type == none || seen.type == wanted_ ||
        crossings_of(knot_name(seen.type)) > crossings_) {
      continue;
    }
    PathPlan to_there{path_reached(tying.path, seen.from), {}, {}};
    std::vector<PathPlan>& paths = paths_[key(seen.type)];
    const auto is_there = [&](const PathPlan& plan) { return same(plan.path, to_there.path); };
    if (std::ranges::any_of(paths, is_there)) continue;  // its try went on from there
    if (seen.reached && same(seen.reached->path, to_there.path)) to_there.reached = seen.reached;
    keep(number, to_there, paths);
  }
  for (const Type& type : seen_here) ++counts_[type];
  if (tying.path.pull.empty()) return;
  keep(number, tying.path, tying.tied() == wanted_ ? tied_ : lost_);
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
