#include "experiments/audit/audit_checkpoints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/log/build_info.hpp"
#include "core/log/log_writer.hpp"
#include "core/log/saved_run.hpp"
#include "core/step/outcome.hpp"
#include "experiments/audit/audited_frame.hpp"

namespace hagfish {
namespace {

/// On the machine that made the log checkpoints come again to the last bit. Another one's compiler
/// rounds otherwise, which grows, where the knot slides, by some orders in a checkpoint's interval:
/// there the next frame is compared, to cm, rad, and their rates per s.
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
        exact_(is_of_this_build(log.h5)),
        end_(steps_.first + static_cast<std::int64_t>(log.h5.shape("/steps/kkt").at(0))) {}

  Finding finding() {
    const std::vector<LoggedCheckpoint> marks = logged_checkpoints(log_.h5);
    const std::vector<std::uint8_t> end = log_.h5.bytes(last_checkpoint);
    const Simulation last = run_of(end).sim;
    if (last.step != end_) {
      throw FileError(fmt::format("{}: {} is before step {}, and the log ends before step {}",
                                  log_.h5.file(), last_checkpoint, last.step, end_));
    }
    if (log_.has_end() && !is_frame(log_.begun, last.now.state)) {
      return {"checkpoints", false, "the last frame is not the state at the end", "", "", ""};
    }
    if (const std::string gone = first_missing(marks); !gone.empty()) {
      return {"checkpoints", false, gone, "", "", ""};
    }
    for (std::size_t k = steps_.first == 0 ? 0 : 1; k <= marks.size(); ++k) {
      Run run = k == 0 ? Run{start(log_.model, scene_, qp_), empty()} : run_of(marks[k - 1].bytes);
      if (k > 0 && run.sim.step != marks[k - 1].step) {
        throw FileError(log_.h5.file() + ": /checkpoints/step is not that of /checkpoints/data");
      }
      const std::vector<std::uint8_t>& next = k < marks.size() ? marks[k].bytes : end;
      const std::int64_t from = run.sim.step;
      try {
        exact_ ? see_next(std::move(run), next)
               : follow(std::move(run.sim), k == marks.size(), last);
      } catch (const StepError& error) {  // a state or a scene that is not the log's
        ++seen_;
        if (first_wrong_.empty()) {
          first_wrong_ = fmt::format("; on from step {}: {}", from, error.what());
        }
      }
    }
    if (seen_ == 0) {
      return {"checkpoints", true, "none before the log's end", "", "", ""};
    }
    return all_of("checkpoints", same_, seen_, "states",
                  exact_
                      ? fmt::format("{} of {} come again bit by bit, with all that they hold, "
                                    "each from the one before{}",
                                    same_, seen_, first_wrong_)
                      : fmt::format("{} of {} states come again from the start and {} "
                                    "checkpoints, off by {:.2g} cm, rad or their rates at most "
                                    "({:g}){}",
                                    same_, seen_, marks.size(), worst_, same_state, first_wrong_));
  }

 private:
  struct Run {
    Simulation sim;
    LogState log;
  };

  LogState empty() const { return {RunningMeans(log_.model.nv()), {}, {}}; }

  Run run_of(const std::vector<std::uint8_t>& bytes) const {
    LogState log = empty();
    try {
      Simulation sim = decode(bytes, log_.model, qp_, log);
      return {std::move(sim), std::move(log)};
    } catch (const std::exception& error) {
      throw FileError(fmt::format("{}: /checkpoints: {}", log_.h5.file(), error.what()));
    }
  }

  /// The first step before which there should be a checkpoint and is none, or one too many.
  std::string first_missing(const std::vector<LoggedCheckpoint>& marks) const {
    const std::int64_t stride = checkpoint_stride(scene_.time);
    std::size_t k = 0;
    for (std::int64_t step = (steps_.first / stride + 1) * stride; step <= end_; step += stride) {
      if (k == marks.size() || marks[k].step != step) {
        return fmt::format(
            "none before step {}, {:g} s, though time.checkpoint_interval asks for "
            "it",
            step, static_cast<double>(step) * scene_.time.step);
      }
      ++k;
    }
    return k == marks.size() ? "" : fmt::format("one too many before step {}", marks[k].step);
  }

  /// Takes a run on to where the checkpoint `next` stands, and compares all that it holds. Warnings
  /// are those of `next`.
  void see_next(Run run, const std::vector<std::uint8_t>& next) {
    auto [wanted, log] = run_of(next);
    StepRecord record;
    bool same = true;
    while (run.sim.step < wanted.step) {
      if (const auto frame = frame_of(run.sim)) {
        const State& state = run.sim.now.state;
        same = same && is_frame(*frame, state);
      }
      take_step(log_.model, scene_, run.sim, record);
      const ThigmotaxisRows rows =
          thigmotaxis_rows_of(record.control, record.solution, scene_.time.step);
      run.log.worst.take(record);
      if (record.step % steps_.stride == 0) {
        run.log.means.close();
        run.log.worst = {};
      }
      run.log.means.take(record, rows);
    }
    run.log.warnings = log.warnings;
    same = same && encode(run.sim, run.log) == next;
    same_ += same ? 1 : 0;
    ++seen_;
    if (!same && first_wrong_.empty()) {
      first_wrong_ =
          fmt::format("; not that before step {}, {:g} s", wanted.step, time_of(wanted, scene_));
    }
  }

  bool is_frame(Eigen::Index frame, const State& state) const {
    return state.q == log_.q.row(frame).transpose() &&
           state.qdot == log_.qdot.row(frame).transpose();
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
  std::optional<Eigen::Index> frame_of(const Simulation& sim) const {
    const std::int64_t since = sim.step - steps_.first;
    const Eigen::Index frame = since / steps_.stride;
    return since % steps_.stride == 0 && frame < log_.begun ? std::optional(frame) : std::nullopt;
  }

  void see_frame(const Simulation& sim) {
    if (const auto frame = frame_of(sim)) see(sim, {log_.q.row(*frame), log_.qdot.row(*frame)});
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
  bool exact_;        // this build on this machine made the log
  std::int64_t end_;  // the step that would come next
  std::int64_t same_ = 0, seen_ = 0;
  double worst_ = 0;
  std::string first_wrong_;
};

}  // namespace

bool is_of_this_build(const Hdf5Reader& h5) {
  return h5.root_text("git_revision") == build_revision() &&
         h5.root_text("compiler") == build_compiler() && h5.root_text("cpu") == cpu_name();
}

bool comes_again(const LogContents& log) {
  return is_of_this_build(log.h5) && !log.own_law() && !log.h5.has_root_attribute("resumed") &&
         !log.h5.has_root_attribute("branched_from");
}

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
