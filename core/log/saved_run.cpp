#include "core/log/saved_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/log/log_header.hpp"
#include "core/run/laws.hpp"

namespace hagfish {
namespace {

/// The run as `bytes` hold it.
SavedRun run_of(const Hdf5Reader& h5, std::span<const std::uint8_t> bytes) {
  ResolvedScene resolved = read_scene_text(h5.root_text("scene"), h5.file() + ": scene");
  Model model = make_hagfish(resolved.specimen, resolved.scene);
  const std::string qp = h5.root_text("qp");
  LogState log{RunningMeans(model.nv()), {}, {}};
  Simulation sim = [&] {
    try {
      return decode(bytes, model, qp, log);
    } catch (const FileError& error) {
      throw FileError(fmt::format("{}: {}", h5.file(), error.what()));
    } catch (const std::invalid_argument& error) {  // no such back end
      throw FileError(fmt::format("{}: {}", h5.file(), error.what()));
    }
  }();
  if (!fits_law(model, resolved.scene, sim.controller.memory)) {
    throw FileError(h5.file() +
                    ": the memory in a checkpoint does not fit the scene's controller.law");
  }
  const std::vector<double> wall_time = h5.doubles("/diagnostics/wall_time");
  return {std::move(resolved),
          std::move(model),
          qp,
          level_of(h5),
          std::move(sim),
          std::move(log),
          wall_time.empty() ? 0 : wall_time.back(),
          h5.has_root_attribute("resumed") ? h5.root_text("resumed") : "",
          h5.root_text("git_revision")};
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

SavedRun saved_run(const Hdf5Reader& h5) {
  require_log(h5);
  require_own_steps(h5);
  if (h5.root_text("status") == "complete") {
    throw FileError(h5.file() + ": the run is complete");
  }
  return run_of(h5, h5.bytes(last_checkpoint));
}

std::vector<LoggedCheckpoint> logged_checkpoints(const Hdf5Reader& h5) {
  const std::vector<std::int64_t> steps = h5.integers("/checkpoints/step");
  const std::vector<std::int64_t> ends = h5.integers("/checkpoints/end");
  const std::vector<std::uint8_t> bytes = h5.bytes(checkpoint_data);
  const bool fits = ends.size() == steps.size() && std::ranges::is_sorted(steps) &&
                    std::ranges::is_sorted(ends) && (ends.empty() || ends.front() >= 0) &&
                    (ends.empty() ? 0 : ends.back()) == static_cast<std::int64_t>(bytes.size());
  if (!fits) {
    throw FileError(h5.file() +
                    ": the file is damaged: /checkpoints/step, end and data do not fit each other");
  }
  std::vector<LoggedCheckpoint> checkpoints;
  std::int64_t begin = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    checkpoints.push_back({steps[k], {bytes.begin() + begin, bytes.begin() + ends[k]}});
    begin = ends[k];
  }
  return checkpoints;
}

SavedRun saved_run_at(const Hdf5Reader& h5, double time) {
  require_log(h5);
  require_own_steps(h5);
  require_level(h5, LogLevel::full);
  const double h = read_scene_text(h5.root_text("scene"), h5.file() + ": scene").scene.time.step;
  const std::vector<LoggedCheckpoint> all = logged_checkpoints(h5);
  // Half a step of slack: the time of a step is a product and may come out larger by rounding.
  const auto behind = std::ranges::find_if(all, [&](const LoggedCheckpoint& checkpoint) {
    return (static_cast<double>(checkpoint.step) - 0.5) * h > time;
  });
  if (behind == all.begin()) {
    throw FileError(all.empty()
                        ? h5.file() + ": has no checkpoint"
                        : fmt::format("{}: has no checkpoint up to {:g} s; the first one is at "
                                      "{:g} s",
                                      h5.file(), time, static_cast<double>(all[0].step) * h));
  }
  return run_of(h5, std::prev(behind)->bytes);
}

}  // namespace hagfish
