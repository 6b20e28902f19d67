#include "core/log/reading/logged_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/control/laws.hpp"
#include "core/run/drive.hpp"

namespace hagfish {
namespace {

/// Logs of before 0.3 have keys that are no settings any more.
std::string without_former_keys(std::string text) {
  for (const char* key :
       {"checkpoint_interval", "momentum_gain", "force_balance", "forward_inverse"}) {
    const std::size_t at = text.find(std::string("\n") + key + " = ");
    if (at != std::string::npos) text.erase(at, text.find('\n', at + 1) - at);
  }
  return text;
}

ResolvedScene scene_of(const std::string& text, const std::string& file,
                       const std::vector<std::string>& overrides = {}) {
  return read_scene_text(without_former_keys(text), file + ": scene", overrides);
}

/// Scenes of a branch before its own.
std::vector<SceneBefore> past_of(const Hdf5Reader& h5) {
  std::vector<SceneBefore> past;
  if (!h5.has(past_scenes)) return past;
  const std::vector<std::string> scenes = h5.texts(past_scenes);
  const std::vector<double> ends = h5.doubles(past_ends);
  if (scenes.size() != ends.size()) throw FileError(h5.file() + ": /branch is damaged");
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    past.push_back({scenes[k], static_cast<std::int64_t>(ends[k])});
  }
  return past;
}

}  // namespace

void require_log(const Hdf5Reader& h5) {
  if (h5.root_text("format") != log_format) {
    throw FileError(fmt::format("{}: not a {} file", h5.file(), log_format));
  }
  if (h5.root_int("format_version") != log_format_version) {
    throw FileError(fmt::format("{}: format version {}, this program reads {}", h5.file(),
                                h5.root_int("format_version"), log_format_version));
  }
}

void require_own_steps(const Hdf5Reader& h5) {
  if (h5.has_root_attribute("simulator")) {
    throw FileError(fmt::format(
        "{}: made by {}; only logs of this program's own steps can be audited or continued",
        h5.file(), h5.root_text("simulator")));
  }
}

LogLevel level_of(const Hdf5Reader& h5) {
  if (!h5.has_root_attribute("log_level")) return LogLevel::full;
  try {
    return log_level_called(h5.root_text("log_level"));
  } catch (const std::invalid_argument& error) {
    throw FileError(fmt::format("{}: attribute log_level: {}", h5.file(), error.what()));
  }
}

void require_level(const Hdf5Reader& h5, LogLevel least) {
  if (const LogLevel level = level_of(h5); level < least) {
    throw FileError(
        fmt::format("{}: made with --log {}, but this command needs a log made with --log {}",
                    h5.file(), log_level_name(level), log_level_name(least)));
  }
}

ResolvedScene logged_scene(const Hdf5Reader& h5, const std::vector<std::string>& overrides) {
  return scene_of(h5.root_text("scene"), h5.file(), overrides);
}

std::string why_not_again(const Hdf5Reader& h5) {
  if (h5.has_root_attribute("simulator")) return h5.root_text("simulator") + " took its steps";
  if (logged_scene(h5).scene.controller.law == own_law) return "the law is the run's own";
  // Branches of before 0.3 do not have what they were before.
  const bool told = h5.has(past_scenes) || !h5.has_root_attribute("branched_from");
  return told ? "" : "where the branch began is in another log";
}

LoggedRun logged_run(const Hdf5Reader& h5) {
  require_log(h5);
  if (const std::string why = why_not_again(h5); !why.empty()) {
    throw FileError(h5.file() + ": cannot be run again: " + why);
  }
  LoggedRun run{logged_scene(h5), h5.root_text("qp"), past_of(h5), 0};
  const std::vector<std::int64_t> steps = h5.integers("/trajectory/step");
  double begin = 0;
  if (!run.past.empty()) {
    const auto& [text, end] = run.past.back();
    begin = static_cast<double>(end) * scene_of(text, h5.file()).scene.time.step;
  }
  const double h = run.resolved.scene.time.step;
  if (steps.empty() || std::abs(static_cast<double>(steps[0]) * h - begin) >= 0.5 * h) {
    throw FileError(
        fmt::format("{}: does not begin where its run does, at {:g} s", h5.file(), begin));
  }
  run.steps = steps.back();
  return run;
}

void go_on_to(std::int64_t step, const Model& model, const Scene& scene, Simulation& sim) {
  StepRecord record;
  const Status end =
      drive(model, scene, sim, record, {}, [&sim, step] { return sim.step >= step; });
  if (sim.step == step) return;
  if (!end.ok() && end.outcome != Outcome::stopped) throw StepError(end);
  throw FileError(fmt::format("the run is at step {}, not at step {} of its log", sim.step, step));
}

Simulation begin_again(const LoggedRun& run) {
  if (run.past.empty()) return start(run.resolved.model, run.resolved.scene, run.qp);
  ResolvedScene now = scene_of(run.past[0].scene, "origin");
  Simulation sim = start(now.model, now.scene, run.qp);
  for (std::size_t k = 0; k < run.past.size(); ++k) {
    go_on_to(run.past[k].end, now.model, now.scene, sim);
    const bool last = k + 1 == run.past.size();
    ResolvedScene next = last ? run.resolved : scene_of(run.past[k + 1].scene, "origin");
    branch(now, next, sim);
    now = std::move(next);
  }
  return sim;
}

void branch(const ResolvedScene& before, const ResolvedScene& after, Simulation& sim) {
  const auto text = [](const ResolvedScene& of) { return scene_to_toml(of.scene, of.specimen); };
  if (text(before) != text(after)) change_scene(after.model, before.scene, after.scene, sim);
  sim.watch = {};  // a branch's own log warns of what it does
}

}  // namespace hagfish
