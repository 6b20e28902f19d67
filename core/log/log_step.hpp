// What the log holds of every step, before any file is there.
#pragma once

#include "core/log/log_level.hpp"
#include "core/log/log_table.hpp"
#include "core/log/means/thigmotaxis_rows.hpp"
#include "core/run/simulation.hpp"

namespace hagfish {

/// What is logged of every step.
struct LoggedStep {
  const StepRecord& record;
  const ThigmotaxisRows& thigmotaxis;
};

/// The datasets along the steps, /steps: few figures, but of every step.
LogTable<LoggedStep> step_table(const Scene& scene, LogLevel level);

}  // namespace hagfish
