#include "experiments/design/tail_path.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hagfish {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr int most_turns = 24;          // waypoints: the tail is used up before
constexpr double displacement = 0.015;  // of a waypoint by a mutation, body lengths

/// A strand that the tail winds about, as a line.
struct Strand {
  Eigen::Vector3d point, along, across, beside;
};

/// The part of the body that lies straight, or that which the swing leads back to it: where these
/// are is known well enough before anything has moved.
Strand choose_strand(const TailPath& path, Draw& draw) {
  Strand strand;
  if (draw.chance(0.6)) {
    strand.point.setZero();
    strand.along = Eigen::Vector3d::UnitX();
  } else {
    strand.point = {path.swing.back().place.x() - draw.uniform(0, 0.1), 0.1, 0.03};
    strand.along = Eigen::Vector3d(draw.uniform(0.1, 0.8), 1, draw.uniform(-0.1, 0.2)).normalized();
  }
  strand.across = strand.along.cross(Eigen::Vector3d::UnitZ()).normalized();
  strand.beside = strand.along.cross(strand.across);
  return strand;
}

double last_time(const TailPath& path) {
  return path.turns.empty() ? path.swing.back().time : path.turns.back().time;
}

Eigen::Vector3d last_place(const TailPath& path) {
  return path.turns.empty() ? path.swing.back().place : path.turns.back().place;
}

void add_turns(TailPath& path, int count, Draw& draw) {
  Eigen::Vector3d place = last_place(path);
  double time = last_time(path);
  while (count > 0 && path.turns.size() < most_turns) {
    const Strand strand = choose_strand(path, draw);
    const Eigen::Vector3d from = place - strand.point;
    double along = from.dot(strand.along);
    double angle = std::atan2(from.dot(strand.beside), from.dot(strand.across));
    const double sense = draw.chance(0.5) ? 1 : -1;
    const double advance = draw.uniform(-0.03, 0.03);  // along it, for each waypoint
    // On about this strand for some waypoints, then perhaps about another.
    do {
      angle += sense * draw.uniform(50 * degree, 110 * degree);
      along += advance + 0.015 * draw.normal();
      const double radius = draw.uniform(0.055, 0.13);
      place = strand.point + along * strand.along +
              radius * (std::cos(angle) * strand.across + std::sin(angle) * strand.beside);
      place.x() = std::clamp(place.x(), 0.06, 0.6);
      time += draw.uniform(0.5, 0.75);
      path.turns.push_back({time, place});
      --count;
    } while (count > 0 && path.turns.size() < most_turns && !draw.chance(0.15));
  }
}

void add_pull(TailPath& path, Draw& draw) {
  const Eigen::Vector3d place = last_place(path);
  const double time = last_time(path);
  Eigen::Vector3d way(draw.normal(), draw.normal(), draw.normal());
  way = draw.uniform(0.1, 0.25) * way.normalized();
  path.pull = {{time + 1, place + 0.6 * way}, {time + 2, place + way}};
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

TailPath random_path(Draw& draw) {
  TailPath path;
  add_swing(path, draw);
  add_turns(path, 5 + draw.below(12), draw);
  add_pull(path, draw);
  return path;
}

TailPath mutated_path(const TailPath& parent, Draw& draw) {
  TailPath path = parent;
  const double what = draw.uniform(0, 1);
  if (what < 0.4) {
    for (TailPath::Waypoint& waypoint : path.turns) {
      for (double& x : waypoint.place) x += displacement * draw.normal();
    }
  } else if (what < 0.8) {
    if (!path.turns.empty() && draw.chance(0.4)) {
      path.turns.resize(path.turns.size() -
                        std::min<std::size_t>(path.turns.size(), 1 + draw.below(4)));
    }
    add_turns(path, 1 + draw.below(6), draw);
  }
  if (what > 0.4 || draw.chance(0.3)) add_pull(path, draw);
  return path;
}

TailPath shortened_path(const TailPath& path, double time, Draw& draw) {
  TailPath shorter = path;
  std::erase_if(shorter.turns, [&](const TailPath::Waypoint& at) { return at.time > time; });
  add_pull(shorter, draw);
  return shorter;
}

std::vector<ScriptKnot> script_knots(const TailPath& path, double length) {
  std::vector<ScriptKnot> knots;
  for (const auto* part : {&path.swing, &path.turns, &path.pull}) {
    for (const TailPath::Waypoint& at : *part) knots.push_back({at.time, length * at.place, {}});
  }
  for (ScriptKnot& knot : knots) knot.noise.setZero();
  return knots;
}

double path_end(const TailPath& path) { return path.pull.back().time; }

}  // namespace hagfish
