// Times of a run as scene files spell them.
#pragma once

#include <optional>
#include <string>

#include "core/scene/settings.hpp"

namespace hagfish {

/// "2.5" s, the start of a phase by its name ("release"), so many seconds after it ("free + 0.5"),
/// or "end"; nothing for any other text.
std::optional<RunTime> run_time_called(const std::string& text);

/// The text that run_time_called() makes the same time of.
std::string run_time_text(const RunTime& time);

}  // namespace hagfish
