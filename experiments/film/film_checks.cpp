#include "experiments/film/film_checks.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/input/input_error.hpp"
#include "experiments/film/fit/film_curve.hpp"

namespace hagfish {
namespace {

/// Two points are no farther apart than the body between them, times the first and with the second
/// (of the body's length) for noise.
constexpr double stretch = 1.1, noise_allowed = 0.03;
/// Above this many points in a midline, pairs are too many to look at.
constexpr Eigen::Index most_pairs_of = 400;
/// Midlines in a row that are the same, from which on they count as repeated.
constexpr std::size_t repeated = 3;
/// Points that two midlines must both have to be called the same.
constexpr std::size_t least_common = 3;
/// A change counts as a jump where it is so many times the usual one, and so much of the body.
constexpr double jump_times = 6, jump_share = 0.04;
/// What follows a frozen film is so many times the usual change off it.
constexpr double thaw_times = 3;
/// Two midlines are turned the other way round where they are nearer so, by this much of the body
/// and by this factor.
constexpr double turned_by = 0.05, turned_nearer = 0.6;
/// Nodes of a curve between edges that cross: fewer are noise.
constexpr Eigen::Index crossing_apart = 4;
/// Of the interval between midlines: what is longer is a gap.
constexpr double gap_times = 2.5;
/// Of the same: what is longer is a fault of the clock, and a program over it would take hours.
constexpr double jump_of_clock = 1000;

double median_or_zero(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

void keep(FilmFrame& frame, const std::vector<bool>& kept) {
  FilmFrame out{frame.time, {}, {}};
  out.point.resize(3, std::ranges::count(kept, true));
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (!kept[k]) continue;
    out.point.col(static_cast<Eigen::Index>(out.place.size())) =
        frame.point.col(static_cast<Eigen::Index>(k));
    out.place.push_back(frame.place[k]);
  }
  frame = std::move(out);
}

bool too_far(const FilmFrame& frame, double length, Eigen::Index a, Eigen::Index b) {
  const double along =
      std::abs(frame.place[static_cast<std::size_t>(b)] - frame.place[static_cast<std::size_t>(a)]);
  return (frame.point.col(a) - frame.point.col(b)).norm() >
         (stretch * along + noise_allowed) * length;
}

/// Points at 0,0: two of them in one midline, or one that is too far from its neighbours.
void drop_zeros(Film& film, FilmRemarks& remarks) {
  std::size_t points = 0;
  std::vector<double> times;
  for (FilmFrame& frame : film.frames) {
    std::vector<bool> kept;
    for (Eigen::Index k = 0; k < frame.point.cols(); ++k) {
      kept.push_back(!frame.point.col(k).isZero(0));
    }
    const auto zeros = std::ranges::count(kept, false);
    if (zeros == 0) continue;
    const auto n = frame.point.cols();
    const auto at = std::ranges::find(kept, false) - kept.begin();
    const bool apart = (at > 0 && too_far(frame, film.length, at - 1, at)) ||
                       (at + 1 < n && too_far(frame, film.length, at, at + 1));
    if (zeros == 1 && !apart) continue;
    points += static_cast<std::size_t>(zeros);
    times.push_back(frame.time);
    keep(frame, kept);
  }
  if (points > 0) {
    remarks.told.push_back(fmt::format("{} points at 0,0 in {} midlines ({} s): taken as missing",
                                       points, times.size(), times_text(times)));
  }
}

/// Points that the body does not reach from where the others are.
void drop_far(Film& film, FilmRemarks& remarks) {
  std::size_t points = 0;
  std::vector<double> times;
  for (FilmFrame& frame : film.frames) {
    const Eigen::Index n = frame.point.cols();
    if (n < 3 || n > most_pairs_of) continue;
    std::vector<std::vector<Eigen::Index>> against(n);
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = a + 1; b < n; ++b) {
        if (!too_far(frame, film.length, a, b)) continue;
        against[a].push_back(b);
        against[b].push_back(a);
      }
    }
    std::vector<bool> kept(n, true);
    std::vector<std::size_t> count;
    for (const auto& others : against) count.push_back(others.size());
    for (;;) {
      const auto worst = std::ranges::max_element(count) - count.begin();
      if (count[worst] == 0) break;
      kept[worst] = false;
      for (const Eigen::Index other : against[worst]) {
        if (count[other] > 0) --count[other];
      }
      count[worst] = 0;
      ++points;
      if (times.empty() || times.back() != frame.time) times.push_back(frame.time);
    }
    keep(frame, kept);
  }
  if (points > 0) {
    remarks.told.push_back(
        fmt::format("{} points in {} midlines ({} s) are farther from the others than the body is "
                    "long: left out",
                    points, times.size(), times_text(times)));
  }
}

std::vector<Eigen::Matrix3Xd> curves_of(const Film& film) {
  std::vector<Eigen::Matrix3Xd> curves;
  for (const FilmFrame& frame : film.frames) curves.push_back(curve_through(frame));
  return curves;
}

double apart(const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  return (a - b).colwise().norm().mean();
}

/// Whether all points that both have are the same, to the last digit: either may lack some.
bool repeats(const FilmFrame& a, const FilmFrame& b) {
  std::size_t common = 0;
  for (std::size_t i = 0, j = 0; i < a.place.size() && j < b.place.size();) {
    if (a.place[i] != b.place[j]) {
      a.place[i] < b.place[j] ? ++i : ++j;
      continue;
    }
    if (a.point.col(static_cast<Eigen::Index>(i)) != b.point.col(static_cast<Eigen::Index>(j)))
      return false;
    ++common, ++i, ++j;
  }
  return common >= least_common;
}

/// Midlines that repeat the one before, where the next one that does not is far from them.
void drop_repeats(Film& film, FilmRemarks& remarks) {
  const std::vector<Eigen::Matrix3Xd> curves = curves_of(film);
  std::vector<double> changes;
  const auto same = [&](std::size_t f) { return repeats(film.frames[f - 1], film.frames[f]); };
  for (std::size_t f = 1; f < curves.size(); ++f) {
    if (!same(f)) changes.push_back(apart(curves[f - 1], curves[f]));
  }
  const double usual = median_or_zero(changes);
  if (!(usual > 1e-4 * film.length)) return;
  std::vector<bool> dropped(film.frames.size(), false);
  for (std::size_t f = 1; f < film.frames.size();) {
    std::size_t end = f;  // of the row of midlines like f - 1
    while (end < film.frames.size() && same(end)) ++end;
    if (end - f + 1 >= repeated) {
      const double from = film.frames[f - 1].time, to = film.frames[end - 1].time;
      if (end == film.frames.size()) {
        remarks.doubts.push_back(
            fmt::format("the midlines from {:g} s to the end at {:g} s are identical: check that "
                        "the animal really stands still",
                        from, to));
      } else if (apart(curves[end - 1], curves[end]) > thaw_times * usual) {
        remarks.told.push_back(fmt::format(
            "the midlines from {:g} to {:g} s are copies of one midline: left out", from, to));
        std::fill(dropped.begin() + static_cast<std::ptrdiff_t>(f),
                  dropped.begin() + static_cast<std::ptrdiff_t>(end), true);
      }
    }
    f = end + 1;
  }
  std::size_t f = 0;
  std::erase_if(film.frames, [&](const FilmFrame&) { return dropped[f++]; });
}

/// A midline whose points are numbered from the other end; `ends` is the sum of the film's first
/// and last place, which need not be the animal's tips.
FilmFrame turned_round(const FilmFrame& frame, double ends) {
  FilmFrame out{
      frame.time, {frame.place.rbegin(), frame.place.rend()}, frame.point.rowwise().reverse()};
  for (double& place : out.place) place = std::clamp(ends - place, 0.0, 1.0);
  return out;
}

/// Which of the midlines [first, end) run the other way round than the first. Each is held against
/// the two before it, and all are decided at once, so that one of them turns no others: the least
/// sum of distances over all ways of turning (Viterbi's path; a state is the turns of two in a
/// row).
std::vector<bool> turns_of(const std::vector<Eigen::Matrix3Xd>& curves, std::size_t first,
                           std::size_t end, double length) {
  using Costs = std::array<double, 4>;  // by 2 * (turn of the one before) + turn
  const auto cost = [&](std::size_t a, std::size_t b, bool other) {
    if (!other) return apart(curves[a], curves[b]);
    const double round = apart(curves[a], curves[b].rowwise().reverse());
    return std::max(round + turned_by * length, round / turned_nearer);
  };
  Costs costs = {0, INFINITY, INFINITY, INFINITY};
  std::vector<std::array<bool, 4>> earlier(end - first);  // the better turn of the last but two
  for (std::size_t f = first + 1; f < end; ++f) {
    std::array<double, 2> near, far{};
    for (const bool other : {false, true}) {
      near[other] = cost(f - 1, f, other);
      if (f > first + 1) far[other] = cost(f - 2, f, other);
    }
    Costs next;
    for (std::size_t to = 0; to < next.size(); ++to) {
      const bool before = (to & 2) != 0, now = (to & 1) != 0;
      std::array<double, 2> by;
      for (const bool last : {false, true}) {
        by[last] = costs[2 * last + before] + near[before != now] + far[last != now];
      }
      earlier[f - first][to] = by[1] < by[0];
      next[to] = std::min(by[0], by[1]);
    }
    costs = next;
  }
  std::vector<bool> turned(end - first);
  auto state = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
  for (std::size_t k = end - first; k-- > 0;) {
    turned[k] = (state & 1) != 0;
    state = (state >> 1) + 2 * static_cast<std::size_t>(earlier[k][state]);
  }
  return turned;
}

void turn_round(Film& film, FilmRemarks& remarks) {
  const std::vector<Eigen::Matrix3Xd> curves = curves_of(film);
  const double usual = usual_interval(film);
  double head = 1, tail = 0;
  for (const FilmFrame& frame : film.frames) {
    head = std::min(head, frame.place.front());
    tail = std::max(tail, frame.place.back());
  }
  std::vector<double> times;
  for (std::size_t first = 0, end = 0; first < curves.size(); first = end) {
    for (end = first + 1; end < curves.size(); ++end) {  // midlines without a gap between them
      if (film.frames[end].time - film.frames[end - 1].time > 2 * gap_times * usual) break;
    }
    const std::vector<bool> turned = turns_of(curves, first, end, film.length);
    const bool most = 2 * std::ranges::count(turned, true) > std::ssize(turned);
    for (std::size_t f = first; f < end; ++f) {
      if (turned[f - first] == most) continue;
      film.frames[f] = turned_round(film.frames[f], head + tail);
      times.push_back(film.frames[f].time);
    }
  }
  if (!times.empty()) {
    remarks.told.push_back(
        fmt::format("head and tail are exchanged in {} midlines ({} s): turned "
                    "round",
                    times.size(), times_text(times)));
  }
}

void tell_jumps(const Film& film, FilmRemarks& remarks) {
  const std::vector<Eigen::Matrix3Xd> curves = curves_of(film);
  const double interval = usual_interval(film);
  // All points at once: the least of them.
  std::vector<double> least;
  for (std::size_t f = 1; f < curves.size(); ++f) {
    least.push_back((curves[f] - curves[f - 1]).colwise().norm().minCoeff());
  }
  std::vector<double> mean;
  for (std::size_t f = 1; f < curves.size(); ++f) mean.push_back(apart(curves[f - 1], curves[f]));
  const double far = std::max(jump_times * median_or_zero(least), jump_share * film.length);
  const double sudden = std::max(jump_times * median_or_zero(mean), jump_share * film.length);
  std::vector<double> times, sudden_times;
  double largest = 0;
  for (std::size_t f = 1; f < curves.size(); ++f) {
    if (film.frames[f].time - film.frames[f - 1].time > gap_times * interval) continue;
    if (least[f - 1] >= far) {
      largest = std::max(largest, mean[f - 1]);
      times.push_back(film.frames[f].time);
    } else if (mean[f - 1] >= sudden) {
      sudden_times.push_back(film.frames[f].time);
    }
  }
  if (!sudden_times.empty()) {
    remarks.told.push_back(
        fmt::format("the body changes more than {:.2g} {} from one midline to the next ({} s): "
                    "check these times",
                    sudden, film.unit, times_text(sudden_times)));
  }
  if (!times.empty()) {
    remarks.doubts.push_back(
        fmt::format("the whole body jumps by up to {:.2g} {} from one midline "
                    "to the next ({} s): check these times",
                    largest, film.unit, times_text(times)));
  }
}

/// Whether the polygon of a flat curve crosses itself: edges that are no neighbours.
bool crosses(const Eigen::Matrix3Xd& curve) {
  const auto left = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                       const Eigen::Vector3d& c) { return (b - a).cross(c - a).z() > 0; };
  for (Eigen::Index i = 0; i + 1 < curve.cols(); ++i) {
    for (Eigen::Index j = i + crossing_apart; j + 1 < curve.cols(); ++j) {
      const Eigen::Vector3d a = curve.col(i), b = curve.col(i + 1);
      const Eigen::Vector3d c = curve.col(j), d = curve.col(j + 1);
      if (left(a, b, c) != left(a, b, d) && left(c, d, a) != left(c, d, b)) return true;
    }
  }
  return false;
}

void tell_crossings(const Film& film, FilmRemarks& remarks) {
  std::vector<double> times;
  for (const FilmFrame& frame : film.frames) {
    if (crosses(curve_through(frame))) times.push_back(frame.time);
  }
  if (!times.empty()) {
    remarks.doubts.push_back(
        fmt::format("{} midlines cross themselves ({} s): one camera does not show which "
                    "strand is on top",
                    times.size(), times_text(times)));
  }
}

}  // namespace

void end_at(Film& film, double until) {
  if (until == 0) return;
  const std::size_t all = std::max<std::size_t>(film.frames.size(), 1);
  std::erase_if(film.frames, [&](const FilmFrame& f) { return f.time > until; });
  film.expected = film.expected * film.frames.size() / all;
}

double quantile_of(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

double usual_interval(const Film& film) {
  std::vector<double> intervals;
  for (std::size_t f = 1; f < film.frames.size(); ++f) {
    intervals.push_back(film.frames[f].time - film.frames[f - 1].time);
  }
  return median_or_zero(intervals);
}

std::string times_text(const std::vector<double>& times) {
  constexpr std::size_t shown = 5;
  std::string text;
  for (std::size_t k = 0; k < std::min(times.size(), shown); ++k) {
    text += fmt::format("{}{:.4g}", k > 0 ? ", " : "", times[k]);
  }
  if (times.size() > shown) text += fmt::format(" and {} more", times.size() - shown);
  return text;
}

void refuse_jumps(const Film& film) {
  const double usual = usual_interval(film);
  for (const auto& [from, to] : gaps(film)) {
    if (to - from < jump_of_clock * usual) continue;
    throw InputError(fmt::format(
        "its clock goes on from {:g} to {:g} s in one step, where {:g} s are usual: mend "
        "the times, or read up to there by --until {:g}",
        from, to, usual, from));
  }
}

std::vector<std::pair<double, double>> gaps(const Film& film) {
  const double usual = usual_interval(film);
  std::vector<std::pair<double, double>> gaps;
  for (std::size_t f = 1; f < film.frames.size(); ++f) {
    const double from = film.frames[f - 1].time, to = film.frames[f].time;
    if (to - from > gap_times * usual) gaps.emplace_back(from, to);
  }
  return gaps;
}

FilmRemarks tidy(Film& film) {
  FilmRemarks remarks;
  drop_zeros(film, remarks);
  drop_far(film, remarks);
  std::erase_if(film.frames, [](const FilmFrame& frame) { return frame.place.size() < 2; });
  if (film.frames.size() < 2) return remarks;
  drop_repeats(film, remarks);
  turn_round(film, remarks);
  tell_jumps(film, remarks);
  if (film.planar) tell_crossings(film, remarks);
  return remarks;
}

}  // namespace hagfish
