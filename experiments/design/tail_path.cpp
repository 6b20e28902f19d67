#include "experiments/design/tail_path.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hagfish {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr int most_turns = 32;           // waypoints: the tail is used up before
constexpr double displacement = 0.015;   // of a waypoint, body lengths
constexpr double strands_within = 0.25;  // to strands that the tail may wind about, body lengths
constexpr double quickest = 0.35;    // of the tail from waypoint to waypoint, body lengths per s
constexpr double tail_share = 0.25;  // body length next to the tip, which it cannot wind about
constexpr double neck_share = 0.06;  // body length next to the head, which the plate holds

TailPath::Waypoint last_of(const TailPath& path) {
  return path.turns.empty() ? path.swing.back() : path.turns.back();
}

/// A strand that the tail winds about, as a line.
struct Line {
  Eigen::Vector3d point, along, across, beside;

  double angle_of(const Eigen::Vector3d& place) const {
    const Eigen::Vector3d from = place - point;
    return std::atan2(from.dot(beside), from.dot(across));
  }
  Eigen::Vector3d place(double on, double radius, double angle) const {
    return point + on * along + radius * (std::cos(angle) * across + std::sin(angle) * beside);
  }
};

/// A turn on about the strand of the turn before, which has `sense` and goes `along` it on average.
Winding draw_winding(double sense, double along, Draw& draw) {
  Winding turn;
  turn.choice = -1;
  turn.angle = sense * draw.uniform(50 * degree, 110 * degree);
  turn.along = along + 0.015 * draw.normal();
  turn.radius = draw.uniform(0.055, 0.13);
  turn.duration = draw.uniform(0.5, 0.75);
  return turn;
}

/// The part of the body that lies straight, or that which the swing leads back to it: where these
/// are is known well enough before anything has moved.
Line choose_line(const TailPath& path, Draw& draw) {
  Line line;
  if (draw.chance(0.6)) {
    line.point.setZero();
    line.along = Eigen::Vector3d::UnitX();
  } else {
    line.point = {path.swing.back().place.x() - draw.uniform(0, 0.1), 0.1, 0.03};
    line.along = Eigen::Vector3d(draw.uniform(0.1, 0.8), 1, draw.uniform(-0.1, 0.2)).normalized();
  }
  line.across = line.along.cross(Eigen::Vector3d::UnitZ()).normalized();
  line.beside = line.along.cross(line.across);
  return line;
}

/// Turns about lines, whatever the body does in the meantime.
void add_turns_about_lines(TailPath& path, int count, Draw& draw) {
  while (count > 0) {
    const Line line = choose_line(path, draw);
    double on = (last_of(path).place - line.point).dot(line.along);
    double angle = line.angle_of(last_of(path).place);
    const double sense = draw.chance(0.5) ? 1 : -1;
    const double along = draw.uniform(-0.03, 0.03);
    do {
      const Winding turn = draw_winding(sense, along, draw);
      angle += turn.angle;
      on += turn.along;
      Eigen::Vector3d place = line.place(on, turn.radius, angle);
      place.x() = std::clamp(place.x(), neck_share, 0.6);
      path.turns.push_back({last_of(path).time + turn.duration, place});
      --count;
    } while (count > 0 && !draw.chance(0.15));
  }
}

/// Turns about one strand, some on about the same, then perhaps about another.
void draw_turns(PathPlan& plan, int count, Draw& draw) {
  while (count > 0) {
    const double sense = draw.chance(0.5) ? 1 : -1;
    const double along = draw.uniform(-0.03, 0.03);
    double choice = draw.uniform(0, 1);
    do {
      plan.turns.push_back(draw_winding(sense, along, draw));
      plan.turns.back().choice = std::exchange(choice, -1);
      --count;
    } while (count > 0 && !draw.chance(0.15));
  }
}

/// Bodies that the tail may wind about from `place`: within reach of it, or else the nearest.
std::vector<int> strands_near(const Eigen::Vector3d& place, const Eigen::Matrix3Xd& centre) {
  const auto bodies = static_cast<double>(centre.cols());
  const int first = static_cast<int>(neck_share * bodies);
  const int last = static_cast<int>((1 - tail_share) * bodies);
  std::vector<int> near;
  int nearest = first;
  const auto away = [&](int k) { return (centre.col(k) - place).norm(); };
  for (int k = first; k <= last; ++k) {
    if (away(k) < strands_within) near.push_back(k);
    if (away(k) < away(nearest)) nearest = k;
  }
  return near.empty() ? std::vector{nearest} : near;
}

void add_swing(TailPath& path, Draw& draw) {
  // Half of an ellipse from the tail's place to above the body.
  const double to = draw.uniform(0.12, 0.4), height = draw.uniform(0.28, 0.45);
  const double lift = draw.uniform(0, 0.06);
  const double middle = (1 + to) / 2, half = (1 - to) / 2;
  path.swing.push_back({0, {0.995, 0, 0}});
  constexpr int count = 5;
  for (int k = 1; k <= count; ++k) {
    const double share = k / static_cast<double>(count);
    const double angle = share * 150 * degree;
    path.swing.push_back(
        {4.5 * share, {middle + half * std::cos(angle), height * std::sin(angle), lift * share}});
  }
}

}  // namespace

PathPlan random_plan(Draw& draw) {
  PathPlan plan;
  add_swing(plan.path, draw);
  const int count = 5 + draw.below(12);
  if (draw.chance(0.5)) {
    add_turns_about_lines(plan.path, count, draw);
  } else {
    draw_turns(plan, count, draw);
  }
  return plan;
}

PathPlan further_plan(const TailPath& path, Draw& draw) {
  PathPlan plan;
  plan.path = path;
  if (draw.chance(0.35)) {
    Winding off;
    off.off = draw.uniform(0.1, 0.35);
    off.aside = 0.35 * Eigen::Vector3d(draw.normal(), draw.normal(), draw.normal());
    off.duration = draw.uniform(1, 2);
    plan.turns.push_back(off);
  }
  draw_turns(plan, 1 + draw.below(8), draw);
  return plan;
}

TailPath displaced_path(const TailPath& path, Draw& draw) {
  TailPath other = path;
  if (path.pull.empty() || draw.chance(0.8)) {
    for (TailPath::Waypoint& waypoint : other.turns) {
      for (double& x : waypoint.place) x += displacement * draw.normal();
    }
  }
  if (!path.pull.empty() && draw.chance(0.5)) {
    for (double& x : other.pull.back().place) x += 0.1 * draw.normal();
  }
  return other;
}

namespace {

/// Away from the middle of what the tail may wind about.
Eigen::Vector3d place_off(const Eigen::Vector3d& place, const Winding& turn,
                          const Eigen::Matrix3Xd& centre) {
  const auto all_but_tail =
      static_cast<Eigen::Index>((1 - tail_share) * static_cast<double>(centre.cols()));
  const Eigen::Vector3d middle = centre.leftCols(all_but_tail).rowwise().mean();
  return place + turn.off * ((place - middle).normalized() + turn.aside).normalized();
}

Eigen::Vector3d place_about(const Eigen::Vector3d& place, const Winding& turn,
                            const Eigen::Matrix3Xd& centre, int& strand) {
  if (turn.choice >= 0) {
    const std::vector<int> near = strands_near(place, centre);
    strand = near[std::min(
        near.size() - 1, static_cast<std::size_t>(turn.choice * static_cast<double>(near.size())))];
  }
  Line line;
  line.point = centre.col(strand);
  line.along = (centre.col(strand + 2) - centre.col(strand - 2)).normalized();
  line.across = line.along
                    .cross(std::abs(line.along.z()) < 0.8 ? Eigen::Vector3d::UnitZ()
                                                          : Eigen::Vector3d::UnitX())
                    .normalized();
  line.beside = line.along.cross(line.across);
  // Strands are followed for a tenth of the body, as if they were straight.
  const double on = std::clamp((place - line.point).dot(line.along) + turn.along, -0.1, 0.1);
  return line.place(on, turn.radius, line.angle_of(place) + turn.angle);
}

}  // namespace

void add_turn(TailPath& path, const Winding& turn, const Eigen::Matrix3Xd& centre, int& strand) {
  if (path.turns.size() >= most_turns) return;
  const TailPath::Waypoint before = last_of(path);
  Eigen::Vector3d place = turn.off > 0 ? place_off(before.place, turn, centre)
                                       : place_about(before.place, turn, centre, strand);
  place.x() = std::max(place.x(), neck_share);
  const double least = (place - before.place).norm() / quickest;
  path.turns.push_back({before.time + std::max(turn.duration, least), place});
}

void end_with_pull(TailPath& path, double time, const Eigen::Matrix3Xd& centre, Draw& draw) {
  std::erase_if(path.turns, [&](const TailPath::Waypoint& at) { return at.time >= time; });
  const Eigen::Index tip = centre.cols() - 1;
  const Eigen::Vector3d place = centre.col(tip);
  path.turns.push_back({time, place});
  const Eigen::Vector3d points = (place - centre.col(tip - 6)).normalized();
  Eigen::Vector3d way = points + 0.5 * Eigen::Vector3d(draw.normal(), draw.normal(), draw.normal());
  way = draw.uniform(0.1, 0.25) * way.normalized();
  path.pull = {{time + 1, place + 0.6 * way}, {time + 2, place + way}};
}

TailPath path_with_ahead(const TailPath& path, double time, int ahead) {
  TailPath shorter = path;
  shorter.pull.clear();
  while (!shorter.turns.empty() && waypoints_after(shorter, time) > ahead) {
    shorter.turns.pop_back();
  }
  return shorter;
}

int waypoints_after(const TailPath& path, double time) {
  const auto after = [&](const TailPath::Waypoint& at) { return at.time > time; };
  return static_cast<int>(std::ranges::count_if(path.swing, after) +
                          std::ranges::count_if(path.turns, after));
}

std::vector<Waypoint> waypoints_of(const TailPath& path, double length) {
  std::vector<Waypoint> knots;
  for (const auto* part : {&path.swing, &path.turns, &path.pull}) {
    for (const TailPath::Waypoint& at : *part) knots.push_back({at.time, length * at.place, {}});
  }
  for (Waypoint& knot : knots) knot.noise.setZero();
  return knots;
}

double path_end(const TailPath& path) {
  return path.pull.empty() ? last_of(path).time : path.pull.back().time;
}

}  // namespace hagfish
