// Whether a log comes again from its scene.
#pragma once

#include <string>

#include "experiments/audit/audit.hpp"

namespace hagfish {

/// Runs the scene of a log anew, for as many steps, and compares all that both logs hold but wall
/// times and how they were made. A log of this build on this machine must come again bit by bit;
/// the first difference is named. One of another build or machine rounds otherwise, which grows:
/// the velocities of both part, and up to there all numbers must agree. Not judged, and so told: a
/// branch, whose run's start is in another log, and a law of the run's own. Throws as audit().
Finding audit_again(const std::string& file);

}  // namespace hagfish
