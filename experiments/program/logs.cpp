#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "core/run/controller.hpp"
#include "experiments/audit/audit.hpp"
#include "experiments/program/commands.hpp"

namespace hagfish {

int info(const std::string& file) {
  const LogContents log(file);
  for (const char* name : {"status", "created", "command", "creator_version", "git_revision",
                           "libraries", "compiler", "cpu"}) {
    fmt::print("{:<16} {}\n", name, log.h5.root_text(name));
  }
  fmt::print("{:<16} {}\n", "scene", log.resolved.scene.title);
  fmt::print("{:<16} {} bodies, {} velocities\n", "model", log.h5.shape("/model/mass")[0],
             log.qdot.cols());
  fmt::print("{:<16} {} frames, t = {:g} to {:g} s, h = {:g} s, {} steps\n", "frames",
             log.time.size(), log.time.front(), log.time.back(), log.resolved.scene.time.step,
             log.h5.shape("/steps/kkt")[0]);
  fmt::print("{:<16} {:.1f} s\n", "wall time", log.h5.doubles("/diagnostics/wall_time").back());
  const std::vector<double> head_end = log.h5.doubles("/knot/head_end");
  const std::vector<double> tail_end = log.h5.doubles("/knot/tail_end");
  const std::vector<std::int64_t> determinant = log.h5.integers("/knot/determinant");
  const std::vector<std::int64_t> v2 = log.h5.integers("/knot/v2");
  for (std::size_t f = 0; f < log.time.size(); ++f) {
    if (f > 0 && log.phase[f] == log.phase[f - 1]) {
      continue;
    }
    const KnotInvariants type{static_cast<int>(determinant[f]), static_cast<int>(v2[f])};
    fmt::print("{:<16} from {:.2f} s, knot {}{}\n", phase_name(static_cast<Phase>(log.phase[f])),
               log.time[f], knot_name(type),
               std::isnan(head_end[f])
                   ? ""
                   : fmt::format(", contacts from {:.1f} to {:.1f} cm", head_end[f], tail_end[f]));
  }
  return 0;
}

int check(const std::string& file) {
  bool passed = true;
  std::string failed;
  for (const Finding& finding : audit(file)) {
    fmt::print("{:<4} {:<24} {}\n", finding.passed ? "ok" : "FAIL", finding.name, finding.text);
    if (!finding.passed) {
      passed = false;
      failed += (failed.empty() ? "" : ", ") + finding.name;
    }
  }
  if (!passed) {
    std::fflush(stdout);
    fmt::print(stderr, "hagfish: {}: check failed: {}\n", file, failed);
  }
  return passed ? 0 : 1;
}

}  // namespace hagfish
