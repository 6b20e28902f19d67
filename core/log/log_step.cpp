#include "core/log/log_frame.hpp"

#include <array>
#include <string>

#include "core/control/laws.hpp"

namespace hagfish {
namespace {

// Steps are some 500 a second of simulated time; a chunk is read and written as one.
constexpr hsize_t step_chunk_rows = 1024;

const LabelledAxis strands{4, strand_labels};

void declare_thigmotaxis(const Scene& scene, LogTable<LoggedStep>& t) {
  const auto row = [&t](const char* name, const char* unit, const std::string& description,
                        std::array<double, 4> ThigmotaxisRows::*member) {
    t.numbers(
        std::string("/steps/thigmotaxis_") + name, {strands},
        {unit, strand_order + description}, [member](const LoggedStep& s) -> const auto& {
          return s.thigmotaxis.*member;
        });
  };
  row("lambda", "dyn", "multiplier over h of each step", &ThigmotaxisRows::lambda);
  row("speed", "cm/s", "left side of Eq. 6, nan where no row", &ThigmotaxisRows::speed);
  row("slack", "cm/s", "shortfall of the command, nan where no row", &ThigmotaxisRows::slack);
  if (law_of(scene).logs_rows) {
    t.count("/steps/thigmotaxis_others", "rows of Eq. 6 at other contacts than first and last",
            [](const LoggedStep& s) { return s.thigmotaxis.others; });
    t.number("/steps/thigmotaxis_others_slack",
             {"cm/s", "largest shortfall of the command of these rows, nan where none"},
             [](const LoggedStep& s) { return s.thigmotaxis.others_slack; });
  }
}

void declare_midpoint(LogTable<LoggedStep>& t) {
  t.number("/steps/middle_off",
           {"rad/s, cm/s",
            "length of the difference of the velocity by which each step moves and that which "
            "placed its middle"},
           [](const LoggedStep& s) { return s.record.solution.middle.off; });
  t.count("/steps/passes",
          "passes that found the middle of each step: more than time.passes where it settled only "
          "with the bias as it comes",
          [](const LoggedStep& s) { return s.record.solution.middle.passes; });
  t.number("/steps/remaining",
           {"1",
            "what further passes would change, over what the last one did: measured where there "
            "were two, else the step before's to the power of 0.9"},
           [](const LoggedStep& s) { return s.record.solution.middle.remaining; });
}

}  // namespace

LogTable<LoggedStep> step_table(const Scene& scene, LogLevel level) {
  LogTable<LoggedStep> t({level, step_labels, step_chunk_rows, true});
  t.number("/steps/time", {"s", "simulated time at which each step begins"},
           [](const LoggedStep& s) { return s.record.time; });
  t.choice("/steps/solve", {solve_kind_names.begin(), solve_kind_names.end()},
           "least that each step had to solve",
           [](const LoggedStep& s) { return s.record.solution.kind; });
  t.count("/steps/rows", "rows in the problem of each step",
          [](const LoggedStep& s) { return s.record.solution.rows.size(); });
  t.count("/steps/iterations", "back end iterations of each step",
          [](const LoggedStep& s) { return s.record.solution.iterations; });
  t.count("/steps/eq6", "Eq. 6 at each step: -1 no rows, 0 with slack, 1 met",
          [](const LoggedStep& s) {
            return s.thigmotaxis.any ? static_cast<int>(s.thigmotaxis.met) : -1;
          });
  declare_thigmotaxis(scene, t);
  t.number("/steps/kkt", {"1", "largest KKT residual of each step"},
           [](const LoggedStep& s) { return s.record.solution.worst_residual(); });
  t.number("/steps/penetration", {"cm", "deepest at each step's start"},
           [](const LoggedStep& s) { return s.record.after.observation.penetration; });
  t.number("/steps/left_out",
           {"s", "time of each step's motion that is left out, where strands meet too fast for it"},
           [](const LoggedStep& s) { return s.record.left_out; });
  t.number("/steps/limit_violation", {"rad", "largest at each step's start"},
           [](const LoggedStep& s) { return s.record.after.observation.limit_violation; });
  t.number("/steps/head_drift", {"cm", "at each step's start while clamped"},
           [](const LoggedStep& s) { return s.record.head_drift; });
  t.number("/steps/qp_time", {"s", "wall time in the QP back end, each step"},
           [](const LoggedStep& s) { return s.record.solution.qp_time; });
  if (scene.time.rule == TimeRule::midpoint) declare_midpoint(t);
  return t;
}

}  // namespace hagfish
