#include "experiments/program/run_again.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>

#include "core/log/log_writer.hpp"
#include "core/log/saved_run.hpp"
#include "core/log/seal.hpp"
#include "experiments/audit/audit_checkpoints.hpp"
#include "experiments/program/run_header.hpp"

namespace hagfish {
namespace {

namespace fs = std::filesystem;

/// Two runs have parted where velocities differ by this share of the largest; forces, which are
/// changes of velocity over a step, differ by more: by `parted_forces` of the largest of their
/// dataset.
constexpr double parted = 1e-9;
constexpr double parted_forces = 1e-3;

/// A log in a folder of its own, which goes with it.
class Rerun {
 public:
  Rerun(const LogContents& log, std::int64_t steps) {
    std::string name = (fs::temp_directory_path() / "hagfish-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw FileError(name + ": cannot be made: " + std::strerror(errno));
    }
    folder_ = name;
    const Scene& scene = log.resolved.scene;
    const std::string qp = log.h5.root_text("qp");
    LogWriter writer(file(), false, log_header(log.resolved, log.model, qp, ""), log.model, scene);
    Simulation sim = start(log.model, scene, qp);
    StepRecord record;
    try {
      while (sim.step < steps) {
        take_step(log.model, scene, sim, record);
        writer.write(record, sim, 0);
      }
      writer.finish("complete", sim);
    } catch (const StepError& error) {
      writer.finish(std::string("failed: ") + error.what(), sim);
    }
  }
  ~Rerun() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  Rerun(const Rerun&) = delete;
  Rerun& operator=(const Rerun&) = delete;

  fs::path file() const { return folder_ / "again.h5"; }

 private:
  fs::path folder_;
};

/// Datasets that a sealed log holds, but those that say how long the computer took.
std::vector<std::string> datasets(const Hdf5Reader& h5) {
  std::vector<std::string> paths;
  for (const auto& [name, digest] : read_seal(h5.text(seal_path))) {
    const bool wall = name.ends_with("/qp_time") || name.ends_with("/wall_time");
    const bool link = digest == 0;  // to labels that are elsewhere in the file
    if (!wall && !link && name.find(": attribute ") == std::string::npos) paths.push_back(name);
  }
  return paths;
}

/// Rows of a series as numbers, or of texts as their lengths and characters.
Hdf5Reader::Rows numbers(const Hdf5Reader& h5, const std::string& path) {
  if (h5.type(path) == H5T_FLOAT) return h5.rows(path);
  std::vector<double> values;
  if (h5.type(path) == H5T_STRING) {
    for (const std::string& text : h5.texts(path)) {
      values.push_back(static_cast<double>(std::hash<std::string>()(text)));
    }
  } else {
    const std::vector<std::int64_t> whole = h5.integers(path);
    values.assign(whole.begin(), whole.end());
  }
  const std::vector<hsize_t> shape = h5.shape(path);
  const auto rows = static_cast<Eigen::Index>(shape.empty() ? 1 : shape[0]);
  const auto width = rows > 0 ? static_cast<Eigen::Index>(values.size()) / rows : 0;
  return Eigen::Map<const Hdf5Reader::Rows>(values.data(), rows, width);
}

/// The first row at which two differ by more than `tolerance` of the largest number; a difference
/// in extent is one behind the shorter one's end.
std::optional<Eigen::Index> first_difference(const Hdf5Reader::Rows& a, const Hdf5Reader::Rows& b,
                                             double tolerance) {
  const auto finite = [](double v) { return std::isfinite(v) ? std::abs(v) : 0; };
  const double scale = a.size() > 0 ? a.unaryExpr(finite).maxCoeff() : 0;
  const auto same = [&](double x, double y) {
    if (tolerance == 0) return std::memcmp(&x, &y, sizeof x) == 0;
    return (std::isnan(x) && std::isnan(y)) || x == y || std::abs(x - y) <= tolerance * scale;
  };
  const Eigen::Index rows = std::min(a.rows(), b.rows());
  for (Eigen::Index i = 0; i < rows && a.cols() == b.cols(); ++i) {
    for (Eigen::Index k = 0; k < a.cols(); ++k) {
      if (!same(a(i, k), b(i, k))) return i;
    }
  }
  if (a.cols() != b.cols() && rows > 0) return 0;
  return a.rows() != b.rows() ? std::optional(rows) : std::nullopt;
}

/// When a row of a dataset was logged, s; 0 of what is not of frames or steps.
double time_of_row(const LogContents& log, const std::string& path, Eigen::Index row) {
  const auto at = [row](const std::vector<double>& time) {
    return time[std::min<std::size_t>(row, time.size() - 1)];
  };
  if (path.starts_with("/steps/")) return at(log.h5.doubles("/steps/time"));
  if (path.starts_with("/contacts/") || path.starts_with("/eq6/")) {
    const std::string group = path.substr(0, path.find('/', 1));
    const std::vector<std::int64_t> frame = log.h5.integers(group + "/frame");
    return row < std::ssize(frame) ? log.time[frame[row]] : log.time.back();
  }
  if (path == "/checkpoints/step" || path == "/checkpoints/end") {
    return static_cast<double>(log.h5.integers("/checkpoints/step").at(row)) *
           log.resolved.scene.time.step;
  }
  if (path.starts_with("/checkpoints/") || path == "/checkpoints/last") return log.time.back();
  const bool fixed = path.starts_with("/model/") || path.starts_with("/mjcf/") ||
                     path.starts_with("/enumerations/");
  return fixed ? 0 : at(log.time);
}

struct Difference {
  double time = INFINITY;
  std::string text;
};

/// A dataset of the rerun, but for the state at its end where the log, of an earlier version or of
/// a run that was killed, has none.
Hdf5Reader::Rows rows_again(const LogContents& log, const Hdf5Reader& again,
                            const std::string& path) {
  const Hdf5Reader::Rows rows = numbers(again, path);
  const bool more = !log.has_end() && again.shape("/trajectory/time").at(0) > log.time.size() &&
                    rows.rows() == log.q.rows() + 1;
  return more ? rows.topRows(log.q.rows()).eval() : rows;
}

/// The earliest difference up to `end` (s), of numbers that may differ by `tolerance`.
Difference earliest(const LogContents& log, const Hdf5Reader& again, double tolerance, double end) {
  Difference first;
  for (const std::string& path : datasets(again)) {
    if (!log.h5.has(path)) return {0, path + " is not there"};
    // How rounding is met, and what is left of it, may be another matter there.
    if (tolerance > 0 && (log.h5.type(path) != H5T_FLOAT || path.starts_with("/mjcf/") ||
                          path.find("kkt") != std::string::npos)) {
      continue;
    }
    const auto row =
        first_difference(numbers(log.h5, path), rows_again(log, again, path), tolerance);
    if (!row) continue;
    const double time = time_of_row(log, path, *row);
    if (time >= first.time || time >= end) continue;
    first = {time, fmt::format("{}, {} {}, {:g} s", path,
                               path.starts_with("/steps/") ? "step" : "row", *row, time)};
  }
  return first;
}

/// When the motion of two runs differs first, s; infinite where it never does.
double parting(const LogContents& log, const Hdf5Reader& again) {
  const auto frame = first_difference(log.qdot, rows_again(log, again, "/trajectory/qdot"), parted);
  return frame ? time_of_row(log, "/trajectory/qdot", *frame) : INFINITY;
}

}  // namespace

Finding audit_again(const std::string& file) {
  const LogContents log(file);
  require_own_steps(log.h5);
  if (log.own_law()) {
    return {"again", true, "not run anew: the law is the run's own", "", "", ""};
  }
  if (log.h5.has_root_attribute("branched_from")) {
    return {"again", true, "not run anew: where the branch begins is in another log", "", "", ""};
  }
  const auto steps = static_cast<std::int64_t>(log.h5.shape("/steps/time").at(0));
  const Rerun rerun(log, steps);
  const Hdf5Reader again(rerun.file(), Origin::own);
  if (comes_again(log)) {
    const Difference first = earliest(log, again, 0, INFINITY);
    return judged({"again", first.text.empty() ? 0.0 : 1.0, 0, "differences"},
                  first.text.empty() ? fmt::format("all of {} steps comes again bit by bit", steps)
                                     : "comes otherwise first: " + first.text);
  }
  const double end = parting(log, again);
  const Difference first = earliest(log, again, parted_forces, end);
  const std::string upto =
      std::isinf(end) ? "to the end" : fmt::format("up to {:g} s, where rounding parts them", end);
  return judged({"again", first.text.empty() && end > 0 ? 0.0 : 1.0, 0, "differences"},
                first.text.empty()
                    ? fmt::format("made by another build or on another machine: the motion agrees "
                                  "to {:g} {}",
                                  parted, upto)
                    : "comes otherwise first: " + first.text);
}

}  // namespace hagfish
