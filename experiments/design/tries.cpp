#include "experiments/design/tries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>

namespace hagfish {
namespace {

constexpr std::size_t kept_of_type = 40;
constexpr double random_share = 0.5;
constexpr double seen_for = 0.8;  // s, before a type on the way is worth a path of its own
constexpr const char* failed_word = "failed";

std::pair<int, int> key(const KnotInvariants& type) { return {type.determinant, type.v2}; }

}  // namespace

TailPath Archive::path_of(int number) const {
  Draw draw(seed_, static_cast<unsigned>(number));
  if (paths_.empty() || draw.chance(random_share)) return random_path(draw);
  const auto type = std::next(paths_.begin(), draw.below(static_cast<int>(paths_.size())));
  const std::vector<TailPath>& paths = type->second;
  return mutated_path(paths[draw.below(static_cast<int>(paths.size()))], draw);
}

void Archive::add(int number, const TailPath& path, const Tying& tying) {
  const KnotInvariants none;
  for (const TypeSeen& seen : tying.seen) {
    if (seen.type == none || seen.to - seen.from < seen_for || &seen == &tying.seen.back()) {
      continue;
    }
    Draw draw(seed_ + 1, static_cast<unsigned>(number));
    keep(number, seen.type, shortened_path(path, seen.from, draw));
  }
  const std::optional<KnotInvariants> tied = tying.tied();
  if (!tied) return;
  ++counts_[key(*tied)];
  if (*tied != none) keep(number, *tied, path);
}

void Archive::keep(int number, const KnotInvariants& type, const TailPath& path) {
  std::vector<TailPath>& paths = paths_[key(type)];
  if (paths.size() < kept_of_type) {
    paths.push_back(path);
  } else {
    paths[static_cast<std::size_t>(number) % kept_of_type] = path;
  }
}

std::string tying_text(const Tying& tying) {
  std::string text;
  for (const TypeSeen& seen : tying.seen) {
    text += fmt::format("{}{} {:.17g} {:.17g}", text.empty() ? "" : " ", knot_name(seen.type),
                        seen.from, seen.to);
  }
  return text + (tying.failed ? std::string(" ") + failed_word : " .");
}

std::optional<Tying> tying_of(const std::string& text) {
  std::istringstream words(text);
  Tying tying;
  std::string name;
  while (words >> name) {
    if (name == "." || name == failed_word) {
      tying.failed = name == failed_word;
      return tying.seen.empty() ? std::nullopt : std::optional(tying);
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
