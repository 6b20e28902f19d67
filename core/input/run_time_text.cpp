#include "core/input/run_time_text.hpp"

#include <cmath>

#include "core/input/input_text.hpp"
#include "core/input/toml/toml_range.hpp"

namespace hagfish {
namespace {

constexpr const char* end_of_run = "end";
constexpr std::string_view plus = " + ";

}  // namespace

std::optional<RunTime> run_time_called(const std::string& text) {
  if (text == end_of_run) return RunTime{std::nullopt, INFINITY};
  if (const auto seconds = finite_number(text)) return RunTime{std::nullopt, *seconds};
  const std::size_t at = text.find(plus);
  const auto later =
      at == text.npos ? std::optional(0.0) : finite_number(text.substr(at + plus.size()));
  for (const PhaseEntry& phase : phase_table) {
    if (later && *later >= 0 && text.substr(0, at) == phase.name) {
      return RunTime{phase.value, *later};
    }
  }
  return std::nullopt;
}

std::string run_time_text(const RunTime& time) {
  if (!time.after) return std::isinf(time.time) ? end_of_run : shortest(time.time);
  const std::string later = time.time == 0 ? "" : std::string(plus) + shortest(time.time);
  return phase_name(*time.after) + later;
}

}  // namespace hagfish
