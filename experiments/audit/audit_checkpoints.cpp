#include "experiments/audit/audit_checkpoints.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/log/build_info.hpp"
#include "core/log/saved_run.hpp"
#include "experiments/audit/audited_frame.hpp"

namespace hagfish {
namespace {

/// On the machine that made the log states agree to the last bit. Another one's compiler rounds
/// otherwise, which grows, where the knot slides, by some orders in a checkpoint's interval: cm,
/// rad, and their rates per s.
constexpr double same_state = 1e-6;

double apart(const State& a, const State& b) {
  return worse((a.q - b.q).lpNorm<Eigen::Infinity>(), (a.qdot - b.qdot).lpNorm<Eigen::Infinity>());
}

class CheckpointAudit {
 public:
  explicit CheckpointAudit(const LogContents& log)
      : log_(log),
        scene_(log.resolved.scene),
        qp_(log.h5.root_text("qp")),
        steps_(log),
        end_(steps_.first + static_cast<std::int64_t>(log.h5.shape("/steps/kkt").at(0))) {}

  Finding finding() {
    const std::vector<LoggedCheckpoint> marks = logged_checkpoints(log_.h5);
    const Simulation last = run_of(log_.h5.bytes(last_checkpoint));
    if (last.step != end_) {
      throw FileError(fmt::format("{}: {} is before step {}, and the log ends before step {}",
                                  log_.h5.file(), last_checkpoint, last.step, end_));
    }
    if (steps_.first == 0) {
      follow(start(log_.model, scene_, qp_), marks.empty(), last);
    }
    for (const LoggedCheckpoint& mark : marks) {
      const Simulation sim = run_of(mark.bytes);
      if (sim.step != mark.step) {
        throw FileError(log_.h5.file() + ": /checkpoints/step is not that of /checkpoints/data");
      }
      follow(sim, &mark == &marks.back(), last);
    }
    if (seen_ == 0) {
      return {"checkpoints", true, "none before the log's end", "", "", ""};
    }
    return all_of(
        "checkpoints", same_, seen_, "states",
        fmt::format("{} of {} states come again from the start and {} checkpoints, off by "
                    "{:.2g} cm, rad or their rates at most ({:g})",
                    same_, seen_, marks.size(), worst_, same_state));
  }

 private:
  Simulation run_of(const std::vector<std::uint8_t>& bytes) const {
    LogState unused{RunningMeans(log_.model.nv()), {}, {}};
    try {
      return decode(bytes, log_.model, qp_, unused);
    } catch (const std::exception& error) {
      throw FileError(fmt::format("{}: /checkpoints: {}", log_.h5.file(), error.what()));
    }
  }

  /// Takes a run on to the next frame, or, where asked, to the end of the log.
  void follow(Simulation sim, bool to_the_end, const Simulation& last) {
    see_frame(sim);
    const std::int64_t to = to_the_end ? end_ : std::min(end_, sim.step + steps_.stride);
    StepRecord record;
    while (sim.step < to) {
      take_step(log_.model, scene_, sim, record);
    }
    if (sim.step == end_) {
      see(sim, last.now.state);
    } else {
      see_frame(sim);
    }
  }

  /// The frame with which the next step of `sim` begins, if there is one.
  void see_frame(const Simulation& sim) {
    const Eigen::Index frame = (sim.step - steps_.first) / steps_.stride;
    if (frame < log_.q.rows()) {
      see(sim, {log_.q.row(frame), log_.qdot.row(frame)});
    }
  }

  void see(const Simulation& sim, const State& logged) {
    const double difference = apart(sim.now.state, logged);
    worst_ = worse(worst_, difference);
    same_ += difference <= same_state ? 1 : 0;
    ++seen_;
  }

  const LogContents& log_;
  const Scene& scene_;
  std::string qp_;
  Steps steps_;
  std::int64_t end_;  // the step that would come next
  std::int64_t same_ = 0, seen_ = 0;
  double worst_ = 0;
};

}  // namespace

bool is_of_earlier_version(const LogContents& log) {
  return log.h5.root_text("git_revision") != build_revision() &&
         is_older_checkpoint(log.h5.bytes(last_checkpoint));
}

Finding audit_checkpoints(const LogContents& log) {
  if (log.own_law()) {
    return {"checkpoints", true, "not followed: the law is the run's own", "", "", ""};
  }
  if (is_of_earlier_version(log)) {
    return {"checkpoints", true, "not followed: made by an earlier version", "", "", ""};
  }
  return CheckpointAudit(log).finding();
}

}  // namespace hagfish
