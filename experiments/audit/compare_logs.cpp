#include "experiments/audit/compare_logs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <optional>

namespace hagfish {
namespace {

/// Two runs have parted where velocities differ by this share of the largest; forces, which are
/// changes of velocity over a step, differ by more: by `parted_forces` of the largest of their
/// dataset.
constexpr double parted = 1e-9;
constexpr double parted_forces = 1e-3;
/// Figures that are nothing but rounding have no scale of their own; in their unit.
constexpr double nothing_but_rounding = 1e-9;
/// What logs had before 0.3 and no run makes again.
const std::vector<std::string> no_more = {"/checkpoints", "/seal"};
/// What logs of earlier versions lack.
const std::vector<std::string> not_before = {"/mean/moments/", "/mean/thigmotaxis/sum",
                                             "/trajectory/curvature"};

/// Rows of a series as numbers, or of texts as digests.
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

bool same_row(const Hdf5Reader::Rows& a, const Hdf5Reader::Rows& b, Eigen::Index row) {
  const auto bytes = static_cast<std::size_t>(a.cols()) * sizeof(double);
  return std::memcmp(a.row(row).data(), b.row(row).data(), bytes) == 0;
}

/// The first row from `begin` on at which two differ by more than `tolerance` of the largest
/// number, or in a bit where that is 0; a difference in extent is one behind the shorter one's end.
std::optional<Eigen::Index> first_difference(const Hdf5Reader::Rows& a, const Hdf5Reader::Rows& b,
                                             double tolerance, Eigen::Index begin = 0) {
  if (a.cols() != b.cols()) return 0;
  const auto finite = [](double v) { return std::isfinite(v) ? std::abs(v) : 0; };
  const double scale = tolerance > 0 && a.size() > 0 ? a.unaryExpr(finite).maxCoeff() : 0;
  const auto near = [&](double x, double y) {
    return (std::isnan(x) && std::isnan(y)) || x == y ||
           std::abs(x - y) <= std::max(tolerance * scale, nothing_but_rounding);
  };
  const Eigen::Index rows = std::min(a.rows(), b.rows());
  for (Eigen::Index i = begin; i < rows; ++i) {
    const double* x = a.row(i).data();
    const double* y = b.row(i).data();
    if (same_row(a, b, i)) continue;
    if (tolerance == 0 || !std::equal(x, x + a.cols(), y, near)) return i;
  }
  return a.rows() != b.rows() ? std::optional(rows) : std::nullopt;
}

bool tells_time_taken(const std::string& path) {
  return path.ends_with("/qp_time") || path.ends_with("/wall_time");
}

/// A log beside its run made again.
class Comparison {
 public:
  Comparison(const LogContents& log, const std::string& again, bool own_build)
      : log_(log), again_(again) {
    const Hdf5Reader::Rows q = rows_again("/trajectory/q");
    const Hdf5Reader::Rows v = rows_again("/trajectory/qdot");
    const Eigen::Index last = log.q.rows() - 1;
    exact_ = own_build || (q.rows() == log.q.rows() &&
                           (same_row(q, log.q, last) || same_row(v, log.qdot, last)));
    if (const auto frame = exact_ ? std::nullopt : first_difference(log.qdot, v, parted)) {
      apart_ = time_of("/trajectory/qdot", *frame);
    }
    compare_root(own_build);
    compare_datasets(own_build);
  }

  /// What is otherwise, the earliest first.
  std::vector<std::string> differences() const {
    std::vector<std::string> texts;
    for (const auto& [time, text] : differences_) texts.push_back(text);
    return texts;
  }
  /// How far it comes again, in words.
  std::string reach() const {
    if (exact_) return "to the end, bit by bit";
    return fmt::format("to {:g} {}", parted,
                       std::isinf(apart_) ? "to the end"
                                          : fmt::format("up to {:g} s, where rounding has parted "
                                                        "the two",
                                                        apart_));
  }

 private:
  void compare_root(bool own_build) {
    std::vector<std::string> names;
    if (exact_) names = {"format", "creator", "log_level", "warnings"};
    if (own_build) names.insert(names.end(), {"creator_version", "libraries", "scene"});
    for (const std::string& name : names) {
      if (log_.h5.root_text(name) != again_.root_text(name)) {
        differ(-INFINITY, fmt::format("attribute {} is another", name));
      }
    }
  }

  void compare_datasets(bool own_build) {
    const std::vector<std::string> made = again_.datasets();
    for (const std::string& path : made) {
      if (!log_.h5.has(path)) {
        const bool later = !own_build && any_begins(path, not_before);
        if (!later) differ(-INFINITY, path + " is not there");
        continue;
      }
      compare_words(path);
      if (log_.h5.type(path) != again_.type(path)) continue;
      if (tells_time_taken(path)) {
        const std::vector<double> taken = log_.h5.doubles(path);
        if (std::ranges::any_of(taken, [](double t) { return t < 0; })) {
          differ(-INFINITY, path + " is below 0");
        }
      } else {
        compare_rows(path);
      }
    }
    for (const std::string& path : log_.h5.datasets()) {
      const bool known = std::ranges::find(made, path) != made.end() || any_begins(path, no_more);
      if (!known) differ(-INFINITY, path + " is not of this run");
    }
  }

  void compare_words(const std::string& path) {
    const auto then = log_.h5.words(path), now = again_.words(path);
    for (const auto& [name, text] : now) {
      // Another revision may have described it otherwise.
      if (name == "description" && !exact_) continue;
      const auto found = then.find(name);
      const std::string& was = found == then.end() ? "" : found->second;
      if (was != text) {
        differ(-INFINITY, fmt::format("{}: {} is '{}', not '{}'", path, name, was, text));
      }
    }
    if (then.size() > now.size()) differ(-INFINITY, path + ": has more attributes");
  }

  void compare_rows(const std::string& path) {
    const Hdf5Reader::Rows then = numbers(log_.h5, path), now = rows_again(path);
    const auto first = first_difference(then, now, 0);
    if (!first) return;
    const double time = time_of(path, *first);
    if (exact_) return tell(path, *first, time);
    // How rounding is met, and what is left of it, may be another matter there.
    if (log_.h5.type(path) != H5T_FLOAT || path.starts_with("/mjcf/") ||
        path.find("kkt") != std::string::npos) {
      return;
    }
    const auto further = first_difference(then, now, parted_forces, *first);
    if (further && time_of(path, *further) < apart_) tell(path, *further, time_of(path, *further));
  }

  void tell(const std::string& path, Eigen::Index row, double time) {
    differ(time, std::isinf(time)
                     ? path
                     : fmt::format("{}, {} {}, {:g} s", path,
                                   path.starts_with("/steps/") ? "step" : "row", row, time));
  }
  void differ(double time, const std::string& text) { differences_.emplace(time, text); }

  /// When a row of a dataset was logged, s; before all of what has no time.
  double time_of(const std::string& path, Eigen::Index row) const {
    const auto at = [row](const std::vector<double>& time) {
      return time[std::min<std::size_t>(row, time.size() - 1)];
    };
    const std::string group = path.substr(0, path.find('/', 1));
    if (group == "/steps") return at(again_.doubles("/steps/time"));
    if (group == "/contacts" || group == "/eq6") {
      const std::vector<std::int64_t> frame = log_.h5.integers(group + "/frame");
      return row < std::ssize(frame) ? log_.time[frame[row]] : log_.time.back();
    }
    const bool fixed =
        group == "/model" || group == "/mjcf" || group == "/enumerations" || group == "/branch";
    return fixed ? -INFINITY : at(log_.time);
  }

  /// A dataset of the rerun, but for the state at its end where the log, of an earlier version or
  /// of a run that was killed, has none.
  Hdf5Reader::Rows rows_again(const std::string& path) const {
    const Hdf5Reader::Rows rows = numbers(again_, path);
    const bool more = !log_.has_end() &&
                      again_.shape("/trajectory/time").at(0) > log_.time.size() &&
                      rows.rows() == log_.q.rows() + 1;
    return more ? rows.topRows(log_.q.rows()).eval() : rows;
  }

  const LogContents& log_;
  Hdf5Reader again_;
  bool exact_ = true;        // all must have the same bits
  double apart_ = INFINITY;  // else: motions differ by more than rounding from then on, s
  std::multimap<double, std::string> differences_;
};

}  // namespace

LogComparison compare_logs(const LogContents& log, const std::string& again, bool own_build) {
  const Comparison comparison(log, again, own_build);
  return {comparison.differences(), comparison.reach()};
}

}  // namespace hagfish
