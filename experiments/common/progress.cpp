#include "experiments/common/progress.hpp"
#include "core/knot/knot.hpp"
#include "experiments/common/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace hagfish {
namespace {

constexpr double terminal_interval = 0.2;  // between redraws, s
constexpr double file_interval = 5;        // between lines where output is no terminal, s
constexpr double first_estimate = 1;       // before this the pace is that of starting, s
// What a run still does after the head is free: the last loop slips off. Only the estimate of the
// time left depends on it, s.
constexpr double release_estimate = 1;
// Where a freshly tied knot begins, share of the body; same use.
constexpr double first_contact_estimate = 0.28;
// Commanded speeds below this do not end the wait, cm/s; same use.
constexpr double least_speed = 0.1;

/// Where the knot is along the body.
std::string span_text(const ControllerState& controller) {
  const auto span = knot_span(controller);
  return span ? fmt::format("{:.1f}-{:.1f} cm", span->head_end, span->tail_end) : "no contact";
}

}  // namespace

Progress::Progress(const Model& model, const Scene& scene, bool quiet)
    : model_(model),
      scene_(scene),
      quiet_(quiet),
      terminal_(isatty(fileno(stderr)) != 0),
      begin_(std::chrono::steady_clock::now()) {}

double Progress::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

double Progress::estimated_end(const StepRecord& record) const {
  const ControllerSettings& c = scene_.controller;
  const double after = release_estimate + c.free_time;
  const auto way = [&](double distance, double speed) {
    return std::max(0.0, distance - c.release_at) / std::max(speed, least_speed);
  };
  const auto slide = [&](double head_end) {
    const bool back = c.leave_by == BodyEnd::tail;
    return way(head_end, c.slide_head.a) +
           (back ? way(model_.length() - c.tight_span, c.reverse_head.a) : 0) + after;
  };
  const double start = record.controller.phase_start;
  const auto span = knot_span(record.controller);
  double end = scene_.time.duration;
  switch (record.controller.phase) {
    case Phase::form:
      if (scene_.script.kind != ScriptSettings::Kind::none) {
        end = std::max(record.time, script_end(scene_.script)) +
              slide(first_contact_estimate * model_.length());
      }
      break;
    case Phase::tighten:
    case Phase::slide:
      end = record.time + slide(span ? span->head_end : 0);
      break;
    case Phase::pull:
      end = start + scene_.food.hold + after;
      break;
    case Phase::reverse:
      end = record.time + way(model_.length() - (span ? span->tail_end : 0), c.reverse_head.a) +
            after;
      break;
    case Phase::release:
      end = std::max(record.time, start + release_estimate) + c.free_time;
      break;
    case Phase::free:
      end = start + c.free_time;
      break;
  }
  return std::min(end, scene_.time.duration);
}

void Progress::show_change(const StepRecord& record) {
  const ControllerState& now = record.controller;
  if (now.phase == phase_ && now.knot.type == type_) {
    return;
  }
  phase_ = now.phase;
  type_ = now.knot.type;
  say("{}{:<8} t = {:6.2f} s  {}  {}{}\n", terminal_ ? "\r" : "", phase_name(phase_), record.time,
      knot_words(type_), span_text(now), terminal_ ? "\x1b[K" : "");
}

void Progress::show(const StepRecord& record) {
  const double wall = elapsed();
  if (quiet_) {
    return;
  }
  show_change(record);
  if (wall < std::max(next_, first_estimate) || record.time == 0) {
    return;
  }
  next_ = wall + (terminal_ ? terminal_interval : file_interval);
  const double speed = record.time / wall;
  const double left = std::max(0.0, estimated_end(record) - record.time) / speed;
  say("{}{:<8} t = {:6.2f} s  {:5.2f} x real time  {:3.0f} s left  {}  {}{}", terminal_ ? "\r" : "",
      phase_name(record.controller.phase), record.time, speed, left,
      knot_words(record.controller.knot.type), span_text(record.controller),
      terminal_ ? "   \x1b[K" : "\n");
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::warn(const StepRecord& record) {
  for (const std::string& warning : record.warnings) {
    end();
    say("hagfish: warning at step {} (t = {:.4f} s): {}\n", record.step, record.time, warning);
  }
}

void Progress::end() {
  if (terminal_ && drawn_ && !quiet_) {
    say("\n");
    drawn_ = false;
  }
}

}  // namespace hagfish
