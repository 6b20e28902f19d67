// The page that a design leaves: what was found, how sure it is and what it takes.
#pragma once

#include <string>
#include <vector>

#include "core/input/files/scene_reader.hpp"
#include "experiments/design/design.hpp"
#include "experiments/judge/judge.hpp"

namespace hagfish {

/// Times at which the film strip shows the way to the knot, and it tied, slid and untied, s.
std::vector<double> strip_times(const RunSummary& run);

/// Markdown. `scene` and `run`: the found scene and its run from a straight start by the paper's
/// law. `strip`: file of the film strip, or empty.
std::string design_page(const DesignOptions& options, const DesignOutcome& outcome,
                        const ResolvedScene& scene, const RunSummary& run,
                        const std::string& strip);

/// The outcome as a row of a table, with its heading: CSV.
std::string design_row(const DesignOptions& options, const DesignOutcome& outcome,
                       const RunSummary& run);

}  // namespace hagfish
