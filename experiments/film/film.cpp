#include "experiments/film/film.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/input/input_text.hpp"
#include "experiments/film/film_checks.hpp"
#include "experiments/film/film_table.hpp"

namespace hagfish {
namespace {

constexpr std::size_t least_points = 5;
/// The least length of a film's animal, cm: what is fitted squares its inverse.
constexpr double least_length = 1e-9;
/// Of places, in the film's unit: what is fitted squares them.
constexpr double largest_place = 1e9;
/// Of the distance of two points over what s says, in the middle: beyond, one is in another unit.
/// Points that are far apart cut corners, and those of a projection lie nearer.
constexpr double least_ratio = 0.7, most_ratio = 1.15;
/// Of the body: about how far apart points are to be compared, and how far at most for the least.
constexpr double compared_apart = 0.06, corners_from = 0.1;
/// Points whose distances from one number to the next differ by no more are even.
constexpr double even_share = 0.1, even_errors = 4;
/// Of an animal's length, what its points may span: noise makes their way longer.
constexpr double most_of_length = 1.1;
/// Of the body between two points, rad: more is noise.
constexpr double most_turn = 2;

/// The rows of a table by time, in each by number.
void sort_points(const std::string& file, FilmTable& table) {
  const auto key = [](const FilmPoint& p) { return std::pair(p.time, p.number); };
  std::ranges::stable_sort(table.points, {}, key);
  const auto same = [&](const FilmPoint& a, const FilmPoint& b) {
    if (key(a) != key(b)) return false;
    if (a.place == b.place || (!a.place.allFinite() && !b.place.allFinite())) return true;
    throw_input_error(fmt::format("{}: time {:g} s: {} {:g} occurs twice with different numbers",
                                  file, a.time, table.by_arc ? "s" : "point", a.number));
  };
  table.points.erase(std::unique(table.points.begin(), table.points.end(), same),
                     table.points.end());
}

/// The way along a body between two points of an arc through them: the chord, and how far the body
/// turns from one end of it to the other.
double arc_over(double chord, double turn) {
  const double half = std::min(turn, most_turn) / 2;
  return half > 0 ? chord * half / std::sin(half) : chord;
}

/// The ways between the points of one midline, from one to the next; NaN where one is missing.
std::vector<double> ways_of(const Eigen::Matrix3Xd& points) {
  const Eigen::Index n = points.cols();
  const Eigen::Matrix3Xd chord = points.rightCols(n - 1) - points.leftCols(n - 1);
  // How much the polygon turns at each point, per length.
  Eigen::VectorXd bend = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const Eigen::Vector3d a = chord.col(i - 1), b = chord.col(i);
    bend[i] = 2 * std::atan2(a.cross(b).norm(), a.dot(b)) / (a.norm() + b.norm());
  }
  std::vector<double> ways;
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    double sum = 0, count = 0;
    for (const double at : {bend[i], bend[i + 1]}) {
      if (!std::isfinite(at)) continue;
      sum += at;
      ++count;
    }
    const double size = chord.col(i).norm();
    ways.push_back(count > 0 ? arc_over(size, sum / count * size) : size);
  }
  return ways;
}

/// Ways from the first number to each, in the film's unit: even, or as far apart as the points are.
/// The last is 0 where no midline has two neighbours.
std::vector<double> ways_to(const std::vector<double>& numbers, const FilmTable& table) {
  const std::size_t n = numbers.size();
  std::vector<std::vector<double>> way(n - 1);
  for (std::size_t k = 0; k < table.points.size();) {
    const double time = table.points[k].time;
    Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Constant(3, static_cast<Eigen::Index>(n),
                                                         std::numeric_limits<double>::quiet_NaN());
    for (; k < table.points.size() && table.points[k].time == time; ++k) {
      const auto i = std::ranges::lower_bound(numbers, table.points[k].number) - numbers.begin();
      points.col(i) = table.points[k].place;
    }
    const std::vector<double> ways = ways_of(points);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      if (std::isfinite(ways[i])) way[i].push_back(ways[i]);
    }
  }
  std::vector<double> middle;
  double known = 0, sum = 0;
  for (std::vector<double>& ways : way) {
    middle.push_back(ways.empty() ? 0 : quantile_of(ways, 0.5));
    known += ways.empty() ? 0 : 1;
    sum += middle.back();
  }
  const double mean_way = known > 0 ? sum / known : 0;
  bool uneven = false;
  for (std::size_t i = 0; i + 1 < n && known == static_cast<double>(n - 1); ++i) {
    const double off = std::abs(middle[i] - mean_way);
    for (double& w : way[i]) w = std::abs(w - middle[i]);
    // Of a median, from the median of what is off it.
    const double error =
        1.9 * quantile_of(way[i], 0.5) / std::sqrt(static_cast<double>(way[i].size()));
    uneven = uneven || (off > even_share * mean_way && off > even_errors * error);
  }
  std::vector<double> to{0};
  for (const double next : middle) to.push_back(to.back() + (uneven ? next : mean_way));
  return to;
}

/// Where each number lies along the body, as a share of it.
std::vector<double> places_of(const std::string& file, const std::vector<double>& numbers,
                              const FilmTable& table, const FilmReading& reading) {
  std::vector<double> places = ways_to(numbers, table);
  const double span = places.back();
  double length = span;
  if (reading.length > 0 || reading.first > 0) {
    if (table.unit != "cm") {
      throw_input_error(file +
                        ": --animal-length and --first-point are in cm: needs --scale or --unit");
    }
    length = reading.length > 0 ? reading.length : reading.first + span;
    if (!(span > 0) || reading.first + span > most_of_length * length) {
      throw_input_error(fmt::format(
          "{}: its points span {:.3g} cm from {:g} cm on: check --animal-length, --first-point, "
          "--scale and --unit",
          file, span, reading.first));
    }
    length = std::max(length, reading.first + span);
  }
  for (std::size_t k = 0; k < places.size(); ++k) {
    places[k] = span > 0 ? (reading.first + places[k]) / length
                         : static_cast<double>(k) / static_cast<double>(places.size() - 1);
  }
  return places;
}

/// Distances of points about `compared_apart` of the body apart, over that, and how far that is.
struct Spacing {
  std::vector<double> ratio, apart;
};
Spacing spacing(const Film& film) {
  Spacing out;
  for (const FilmFrame& frame : film.frames) {
    const std::size_t n = frame.place.size();
    for (std::size_t a = 0, b = 0; a < n; ++a) {
      b = std::max(b, a + 1);
      while (b + 1 < n && frame.place[b] - frame.place[a] < compared_apart) ++b;
      if (b >= n) break;
      const double apart = frame.place[b] - frame.place[a];
      out.apart.push_back(apart);
      out.ratio.push_back((frame.point.col(static_cast<Eigen::Index>(b)) -
                           frame.point.col(static_cast<Eigen::Index>(a)))
                              .norm() /
                          apart);
    }
  }
  return out;
}

}  // namespace

std::size_t Film::present() const {
  std::size_t count = 0;
  for (const FilmFrame& frame : frames) count += frame.place.size();
  return count;
}

Film read_film(const std::string& file, const FilmReading& reading) {
  FilmTable table = read_film_table(file, reading);
  const auto fail = [&](const std::string& why) { throw_input_error(file + ": " + why); };
  sort_points(file, table);
  Film film;
  film.planar = table.planar;
  film.unit = table.unit;
  film.format = table.format;
  film.length_known = table.by_arc;
  // Axes in space are what they are: y turned alone would make the mirror image.
  const bool picture = table.pixels && table.planar;
  const bool down = picture ? !reading.y_up : reading.y_down;
  if (down) film.turned = picture ? "y runs down, as rows of images do" : "y runs down";

  std::vector<double> numbers;
  for (const FilmPoint& point : table.points) numbers.push_back(point.number);
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  if (numbers.size() < least_points) {
    fail(fmt::format("{} points along the body; a midline needs {}", numbers.size(), least_points));
  }
  std::vector<double> places;
  if (table.by_arc) {
    if (table.unit != "cm" && reading.length > 0) fail("--animal-length is in cm: needs --scale");
    if (numbers.front() < 0) fail("s is below 0");
    film.length = reading.length > 0 ? reading.length : numbers.back();
    if (numbers.back() > film.length * (1 + 1e-9)) {
      fail(fmt::format("s = {:g} cm is past --animal-length {:g}", numbers.back(), film.length));
    }
    for (const double s : numbers) places.push_back(std::min(s / film.length, 1.0));
    if (reading.first > 0) fail("--first-point is for numbered points: here s says where each is");
  } else {
    places = places_of(file, numbers, table, reading);
  }
  std::size_t most = 0, rows = 0;
  for (std::size_t k = 0; k < table.points.size();) {
    FilmFrame frame{table.points[k].time, {}, {}};
    std::vector<Eigen::Vector3d> points;
    std::size_t here = 0;
    for (; k < table.points.size() && table.points[k].time == frame.time; ++k, ++here) {
      Eigen::Vector3d place = table.points[k].place;
      if (!place.allFinite()) continue;
      if (place.lpNorm<Eigen::Infinity>() > largest_place) {
        fail(fmt::format("time {:g} s: a point is at {:g} {}: must be at most {:g}", frame.time,
                         place.lpNorm<Eigen::Infinity>(), film.unit, largest_place));
      }
      if (down) place.y() = -place.y();
      points.push_back(place);
      frame.place.push_back(places[static_cast<std::size_t>(
          std::ranges::lower_bound(numbers, table.points[k].number) - numbers.begin())]);
    }
    most = std::max(most, here);
    ++rows;
    if (points.empty()) continue;
    frame.point.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      frame.point.col(static_cast<Eigen::Index>(i)) = points[i];
    }
    film.frames.push_back(std::move(frame));
  }
  film.expected = rows * (table.by_arc ? most : numbers.size());
  if (film.frames.size() < 2) fail("needs midlines at two times or more");

  Spacing spacing = hagfish::spacing(film);
  if (spacing.ratio.empty()) fail("no midline has two points");
  const double apart = quantile_of(spacing.apart, 0.5);
  if (!table.by_arc) film.length = quantile_of(spacing.ratio, 0.75);
  if (!(film.length > least_length))
    fail(fmt::format("the animal would be {:g} cm long: check units and scale", film.length));
  if (table.by_arc) {
    const double ratio = quantile_of(spacing.ratio, 0.5) / film.length;
    const bool near = ratio < least_ratio && !film.planar && apart < corners_from;
    if (ratio > most_ratio || near || ratio < least_ratio * least_ratio * least_ratio) {
      fail(fmt::format(
          "points that are {:.3g} {} apart by s are {:.3g} times as far apart in space: "
          "check units and scale",
          apart * film.length, film.unit, ratio));
    }
  }
  return film;
}

}  // namespace hagfish
