#include "experiments/design/tries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <sstream>

namespace hagfish {
namespace {

constexpr std::size_t kept_of_type = 40;
constexpr double random_share = 0.25;
constexpr double displaced_share = 0.7;      // of paths on which the wanted type was seen, at most
constexpr double doubt = 0.3;                // promise by which half of that is displaced
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
    : seed_(seed), wanted_(*knot_called(*name_in_scene(wanted))), crossings_(crossings_of(wanted)) {
  const std::size_t sum = wanted.find('#');
  if (sum == std::string::npos) return;
  for (const std::string& one : {wanted.substr(0, sum), wanted.substr(sum + 1)}) {
    // Types are blind to mirror images.
    const std::string image = one.starts_with('-') ? one.substr(1) : one;
    summands_.insert(key(*knot_called(*name_in_scene(image))));
  }
}

bool Archive::leads_on(const KnotInvariants& type) const {
  if (!summands_.empty()) return summands_.contains(key(type));
  return type != KnotInvariants{} && crossings_of(knot_name(type)) < crossings_;
}

double Archive::promise(const PathPlan& plan) const {
  double least = std::numeric_limits<double>::infinity();
  for (int line = plan.parent; line >= 0; line = lines_[line].parent) {
    least = std::min(least, (1.0 + lines_[line].passes) / (1.0 + lines_[line].failures));
  }
  return least;
}

const PathPlan& Archive::likely(const std::vector<Kept>& kept, Draw& draw) const {
  double rest = 0;
  for (const Kept& one : kept) rest += promise(one.plan);
  rest = draw.uniform(0, rest);
  for (const Kept& one : kept) {
    rest -= promise(one.plan);
    if (rest < 0) return one.plan;
  }
  return kept.back().plan;
}

bool Archive::would_keep(const TailPath& path, const TypeSeen& seen) const {
  if (seen.at == 0 || !leads_on(seen.type)) return false;
  const auto of_type = paths_.find(key(seen.type));
  if (of_type == paths_.end()) return true;
  const std::vector<Kept>& kept = of_type->second;
  const TailPath to_there = path_reached(path, seen.at);
  const auto is_it = [&](const Kept& one) { return same(one.plan.path, to_there); };
  if (std::ranges::any_of(kept, is_it)) return false;  // a try went on from there
  return kept.size() < kept_of_type || kept.back().left < seen.left;
}

PathPlan Archive::plan_of(int number) const {
  Draw draw(seed_, static_cast<unsigned>(number));
  double promised = 0;
  for (const Kept& one : with_pull_) promised = std::max(promised, promise(one.plan));
  if (draw.chance(displaced_share * promised / (promised + doubt))) {
    const PathPlan& from = likely(with_pull_, draw);
    return {.path = displaced_path(from.path, draw), .turns = {}, .parent = from.parent};
  }
  if (paths_.empty() || draw.chance(random_share)) return random_plan(draw);
  const auto type = std::next(paths_.begin(), draw.below(static_cast<int>(paths_.size())));
  const PathPlan& from = likely(type->second, draw);
  const bool displaced = draw.chance(0.3);
  PathPlan plan = further_plan(displaced ? displaced_path(from.path, draw) : from.path, draw);
  plan.parent = from.parent;
  if (!displaced) plan.reached = from.reached;
  return plan;
}

void Archive::add(int number, const PathPlan& plan, const Tying& tying) {
  lines_.resize(number + 1);
  lines_[number] = {.parent = plan.parent, .failures = 0, .passes = 0};
  std::set<Type> seen_here;
  for (const TypeSeen& seen : tying.seen) {
    if (seen.to == seen.from) continue;
    seen_here.insert(key(seen.type));
    if (!seen.repeats || !would_keep(tying.path, seen)) continue;
    PathPlan to_there{.path = path_reached(tying.path, seen.at), .turns = {}, .parent = number};
    std::vector<Kept>& paths = paths_[key(seen.type)];
    if (seen.reached && same(seen.reached->path, to_there.path)) to_there.reached = seen.reached;
    const auto less =
        std::ranges::find_if(paths, [&](const Kept& kept) { return kept.left < seen.left; });
    paths.insert(less, {to_there, seen.left});
    if (paths.size() > kept_of_type) paths.pop_back();
  }
  for (const Type& type : seen_here) ++counts_[type];
  if (!seen_here.contains(key(wanted_)) || tying.path.pull.empty()) return;
  if (with_pull_.size() == kept_of_type) with_pull_.erase(with_pull_.begin());
  with_pull_.push_back({{.path = tying.path, .turns = {}, .parent = number}, 0});
  if (tying.tied() != wanted_) judged(number, 0);
}

void Archive::judged(int number, int passes) {
  for (int line = number; line >= 0; line = lines_[line].parent) {
    ++lines_[line].failures;
    lines_[line].passes = std::max(lines_[line].passes, passes);
  }
}

std::string tying_text(const Tying& tying) {
  std::string text;
  for (const TypeSeen& seen : tying.seen) {
    text += fmt::format("{}{} {:.17g} {:.17g} {:.17g} {:.17g} {:d}", text.empty() ? "" : " ",
                        knot_name(seen.type), seen.from, seen.to, seen.at, seen.left, seen.repeats);
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
    if (!type || !(words >> seen.from >> seen.to >> seen.at >> seen.left >> seen.repeats)) {
      return std::nullopt;
    }
    seen.type = *type;
    tying.seen.push_back(seen);
  }
  return std::nullopt;
}

}  // namespace hagfish
