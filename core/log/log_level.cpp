#include "core/log/log_level.hpp"

#include <algorithm>
#include <stdexcept>

namespace hagfish {
namespace {

/// What only logs of a level and those above it hold, by how its path begins.
const std::vector<std::string> only_full = {
    "/steps/",  "/midway/",       "/control/",         "/basis/",          "/reflex/",      "/eq6/",
    "/forces/", "/trajectory/qd", "/trajectory/q_ref", "/mean/forces/net", "/muscle/driven"};
const std::vector<std::string> not_in_summaries = {"/trajectory/q",
                                                   "/trajectory/position",
                                                   "/trajectory/curvature",
                                                   "/mean/forces/",
                                                   "/mean/moments/",
                                                   "/contacts/",
                                                   "/forces/",
                                                   "/muscle/",
                                                   "/flesh/"};
const std::vector<std::string> single = {"/trajectory/position", "/mean/forces/", "/muscle/"};
/// What follows from other datasets, and is single at every level.
const std::vector<std::string> always_single = {"/trajectory/curvature", "/mean/moments/"};
/// The one force of a step that replays show, small enough.
const std::string tip = "/forces/tip";

}  // namespace

bool any_begins(const std::string& path, const std::vector<std::string>& beginnings) {
  return std::ranges::any_of(beginnings, [&](const auto& b) { return path.starts_with(b); });
}

const std::vector<std::string>& log_level_names() {
  static const std::vector<std::string> names = {"summary", "frames", "full"};
  return names;
}

const std::string& log_level_name(LogLevel level) {
  return log_level_names().at(static_cast<std::size_t>(level));
}

LogLevel log_level_called(const std::string& name) {
  const auto& names = log_level_names();
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw std::invalid_argument("no level of logs is called " + name);
  return static_cast<LogLevel>(found - names.begin());
}

bool holds(LogLevel level, const std::string& path) {
  if (level == LogLevel::full) return true;
  if (path != tip && any_begins(path, only_full)) return false;
  return level == LogLevel::frames || !any_begins(path, not_in_summaries);
}

bool in_single_precision(LogLevel level, const std::string& path) {
  return any_begins(path, always_single) || (level != LogLevel::full && any_begins(path, single));
}

double resolution(LogLevel level, const std::string& path) {
  if (level == LogLevel::full) return 0;
  return path == "/trajectory/position" ? 0x1p-13 : path == "/trajectory/q" ? 0x1p-32 : 0;
}

}  // namespace hagfish
