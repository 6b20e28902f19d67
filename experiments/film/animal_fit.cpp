#include "experiments/film/animal_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/chain/start.hpp"
#include "core/input/input_error.hpp"
#include "core/run/drive.hpp"
#include "core/scene/interpolation.hpp"
#include "experiments/film/film_checks.hpp"
#include "experiments/film/fit/film_curve.hpp"
#include "experiments/film/fit/film_shape.hpp"

namespace hagfish {
namespace {

constexpr double prior = std::numbers::ln10;  // standard deviation of a factor's logarithm
constexpr double ninety = 1.6449;             // standard deviations to each side of 90 %
// What shapes of so many bodies and stations leave wrong of the logarithms, standard deviations:
// measured where films were made with 150 bodies and fitted with 50, noise aside.
constexpr std::array<double, animal_traits> model_error = {0.01, 0.06, 0.01};
constexpr int most_stations = 12;       // of the start
constexpr double longest_step = 0.002;  // s: a body's third bending mode has a period of 0.1
constexpr int trial_changes = 3, most_changes = 30, most_trials = 8;
constexpr double first_damping = 1e-3, easing = 0.2;  // of Levenberg and Marquardt
// Factors to begin with, of stiffness, damping and drag. Where drag and stiffness alone count, what
// they have in common is told by little, and steps from one start stop in a valley.
constexpr std::array<std::array<double, animal_traits>, 4> first_factors{
    {{1, 1, 1}, {0.2, 0.2, 0.3}, {5, 5, 3}, {0.2, 0.2, 2}}};
constexpr double settled_at = 1e-4;  // relative change of the cost
// Steps of differences: of a factor's logarithm, of a bend (rad per body length), and of rates
// (1/s). Far above the rounding of a run, far below what shapes are curved by.
constexpr double factor_step = 0.01, bend_step = 0.01, rate_step = 0.05;

/// The film's points that are used, all times one after the other, cm of the model.
struct Points {
  Eigen::Matrix3Xd at;
  std::vector<std::vector<double>> place;  ///< of each frame, shares of the length
  std::vector<double> time;                ///< of each frame from the first one on, s
};

Points points_used(const Film& film, const FilmFit& fit) {
  Points points;
  std::vector<Eigen::Vector3d> all;
  for (std::size_t f = 0; f < film.frames.size(); ++f) {
    const FilmFrame& frame = film.frames[f];
    std::vector<double>& place = points.place.emplace_back();
    points.time.push_back(frame.time - film.frames.front().time);
    for (std::size_t k = 0; k < frame.place.size(); ++k) {
      if (!fit.used[f][k]) continue;
      place.push_back(frame.place[k]);
      all.emplace_back(fit.scale * frame.point.col(static_cast<Eigen::Index>(k)));
    }
  }
  points.at.resize(3, static_cast<Eigen::Index>(all.size()));
  for (std::size_t k = 0; k < all.size(); ++k) points.at.col(static_cast<Eigen::Index>(k)) = all[k];
  return points;
}

/// Off the film's points by the nearest rigid motion, a point after the other, cm; a film in two
/// dimensions has its z, too, which is 0 there.
Eigen::VectorXd off(const Eigen::Matrix3Xd& seen, const Points& points) {
  const Eigen::Matrix3Xd moved = nearest_motion(seen, points.at).of(seen);
  return (moved - points.at).reshaped();
}

/// The scene without muscles, script, plate and controller, in fine steps of second order.
ResolvedScene passive(ResolvedScene resolved, FilmHead head, double duration) {
  Scene& scene = resolved.scene;
  if (scene.gravity.norm() > 0) throw InputError("the scene has gravity: choose one without");
  if (!scene.obstacles.empty()) throw InputError("the scene has obstacles: choose one without");
  scene.script = {};
  scene.active = {};
  scene.controller = {};
  scene.controller.tighten_from = duration + 1;
  scene.wall.present = false;
  scene.clamp_head = head == FilmHead::still;
  scene.time.rule = TimeRule::midpoint;
  scene.time.step = std::min(scene.time.step, longest_step);
  scene.time.duration = duration;
  scene.guard.energy_action = EnergyAction::warn;
  return resolved;
}

/// Runs of the animal from starts and with factors that are the unknowns: logarithms of the
/// factors; bends at the stations, about each axis; their rates; of a free head its twist.
class Runs {
 public:
  Runs(const ResolvedScene& resolved, const Film& film, FilmHead head, int stations,
       const Points& points)
      : scene_(resolved.scene),
        model_(make_hagfish(resolved.specimen, resolved.scene)),
        points_(points),
        stations_(stations),
        axes_(film.planar ? 1 : 2),
        free_(head == FilmHead::free ? 3 * axes_ : 0) {}

  Eigen::Index size() const { return animal_traits + 2 * axes_ * stations_ + free_; }
  const Model& model() const { return model_; }
  Eigen::Index first_rate() const { return animal_traits + axes_ * stations_; }

  /// Where the film's points are in a run, 3 x points, cm; nothing where it does not last.
  std::optional<Eigen::Matrix3Xd> operator()(const Eigen::VectorXd& x) const {
    Model model = model_;
    for (Hinge& hinge : model.hinges) {
      hinge.stiffness *= std::exp(x[0]);
      hinge.damping *= std::exp(x[1]);
    }
    model.drag.normal *= std::exp(x[2]);
    model.drag.tangential *= std::exp(x[2]);
    Scene scene = scene_;
    scene.start = {};
    scene.start.bend = rows(x, animal_traits);
    scene.start.bend_rate = rows(x, first_rate());
    State state = start_state(model, scene.start);
    if (free_ > 0) {
      const Eigen::VectorXd twist = x.tail(free_);
      if (axes_ == 1) {  // turn about Z, velocity in the plane
        state.qdot.segment<3>(0).head<2>() = twist.head<2>();
        state.qdot[5] = twist[2];
      } else {
        state.qdot.head<6>() = twist;
      }
    }
    Eigen::Matrix3Xd seen(3, points_.at.cols());
    Eigen::Index filled = 0;
    std::size_t frame = 0;
    Eigen::Matrix3Xd before, after;
    const auto place = [&](const State& of, std::size_t f, Eigen::Matrix3Xd& at) {
      const Kinematics kin = kinematics(model, of);
      at.resize(3, static_cast<Eigen::Index>(points_.place[f].size()));
      for (Eigen::Index k = 0; k < at.cols(); ++k) {
        at.col(k) = point_on(model, kin, points_.place[f][static_cast<std::size_t>(k)]);
      }
    };
    const auto keep = [&](const Eigen::Matrix3Xd& at) {
      seen.middleCols(filled, at.cols()) = at;
      filled += at.cols();
      ++frame;
    };
    place(state, 0, after);
    keep(after);
    try {
      Simulation sim = start_from(model, scene, "active-set", state, {}, 0);
      StepRecord record;
      State last = state;
      const double h = scene.time.step;
      const auto look = [&](const StepRecord&, const Simulation& at) {
        const double time = time_of(at, scene);
        for (; frame < points_.time.size() && points_.time[frame] <= time + 1e-9 * h;) {
          place(last, frame, before);
          place(at.now.state, frame, after);
          const double share = std::clamp((points_.time[frame] - (time - h)) / h, 0.0, 1.0);
          keep((1 - share) * before + share * after);
        }
        last = at.now.state;
      };
      const auto done = [&] { return frame == points_.time.size(); };
      const Status end = drive(model, scene, sim, record, {look}, done);
      if (!end.ok() && end.outcome != Outcome::stopped) return std::nullopt;
    } catch (const StepError&) {
      return std::nullopt;
    }
    if (frame < points_.time.size() || !seen.allFinite()) return std::nullopt;
    return seen;
  }

 private:
  /// Values from `first` on as StartSettings has them.
  std::vector<Eigen::Vector4d> rows(const Eigen::VectorXd& x, Eigen::Index first) const {
    std::vector<Eigen::Vector4d> rows;
    for (Eigen::Index j = 0; j < stations_; ++j) {
      const double station = static_cast<double>(j) / static_cast<double>(stations_ - 1);
      const double z = x[first + (axes_ - 1) * stations_ + j] / model_.length();
      const double y = axes_ == 2 ? x[first + j] / model_.length() : 0;
      rows.emplace_back(station, 0, y, z);
    }
    return rows;
  }

  Scene scene_;
  Model model_;
  const Points& points_;
  Eigen::Index stations_, axes_, free_;
};

/// Bends of the program at a time, at even stations, about each axis of the film.
Eigen::VectorXd bends_at(const CurvatureProgram& program, double time, Eigen::Index stations,
                         Eigen::Index axes) {
  const TablePlace in_time = place_among(program.time, time);
  Eigen::VectorXd bends(axes * stations);
  for (Eigen::Index j = 0; j < stations; ++j) {
    const double station = static_cast<double>(j) / static_cast<double>(stations - 1);
    const TablePlace along = place_among(program.station, station);
    for (Eigen::Index a = 0; a < axes; ++a) {
      bends[a * stations + j] = value_at(in_time, [&](std::size_t t) {
        return value_at(along, [&](std::size_t k) {
          return program.value[t](a + (axes == 1 ? 1 : 0), static_cast<Eigen::Index>(k));
        });
      });
    }
  }
  return bends;
}

/// Unknowns from which no small change leads nearer, and what they leave.
struct Nearest {
  Eigen::VectorXd x, residual;
  Eigen::MatrixXd normal;  ///< inverse of the unknowns' covariance, if residuals are independent
  bool settled = false;
};

/// Rms distance of a run's points from where they begin, cm, of those that the first frame has.
double moved_by(const Eigen::Matrix3Xd& seen, const Points& points) {
  const std::vector<double>& first = points.place.front();
  double square = 0, count = 0;
  Eigen::Index point = 0;
  for (const std::vector<double>& places : points.place) {
    for (const double place : places) {
      if (const auto same = std::ranges::find(first, place); same != first.end()) {
        square += (seen.col(point) - seen.col(same - first.begin())).squaredNorm();
        ++count;
      }
      ++point;
    }
  }
  return std::sqrt(square / count);
}

/// How much more residuals weigh less than they seem, as neighbours in time are alike: (1 + r) /
/// (1 - r) for a correlation r from one frame to the next, no less than 1.
double likeness(const Eigen::VectorXd& residual, const Points& points) {
  double product = 0, square = 0;
  Eigen::Index first = 0;
  for (std::size_t f = 0; f + 1 < points.place.size(); ++f) {
    const auto own = 3 * static_cast<Eigen::Index>(points.place[f].size());
    const auto next = 3 * static_cast<Eigen::Index>(points.place[f + 1].size());
    if (points.place[f] == points.place[f + 1]) {
      product += residual.segment(first, own).dot(residual.segment(first + own, next));
      square += residual.segment(first, own).squaredNorm();
    }
    first += own;
  }
  const double r = square > 0 ? std::clamp(product / square, 0.0, 0.98) : 0;
  return (1 + r) / (1 - r);
}

}  // namespace

AnimalFit fit_animal(const ResolvedScene& resolved, const Film& film, const FilmFit& fit,
                     FilmHead head, const std::function<void(int)>& watch) {
  const Points points = points_used(film, fit);
  const double lasts = points.time.back();
  const int stations = std::clamp(static_cast<int>(fit.program.station.size()), 2, most_stations);
  const Runs run(passive(resolved, head, lasts + longest_step), film, head, stations, points);
  const Model& model = run.model();
  const auto none = [&](double Hinge::*of) {
    return std::ranges::all_of(model.hinges, [&](const Hinge& h) { return h.*of == 0; });
  };
  if (none(&Hinge::stiffness) || none(&Hinge::damping) || model.drag.normal == 0) {
    throw InputError("the scene has no stiffness, damping or drag to scale");
  }
  const Eigen::Index axes = film.planar ? 1 : 2, n = run.size();
  Eigen::VectorXd start = Eigen::VectorXd::Zero(n), step(n);
  start.segment(animal_traits, axes * stations) = bends_at(fit.program, 0, stations, axes);
  step.setConstant(rate_step);
  step.head(animal_traits).setConstant(factor_step);
  step.segment(animal_traits, axes * stations).setConstant(bend_step);
  const double flat = film.planar ? 2.0 : 3.0;
  const auto motion = film.planar ? 3.0 : 6.0;
  const auto numbers = flat * static_cast<double>(points.at.cols());
  const double own = static_cast<double>(n) + motion;
  if (numbers < 2 * own) throw InputError("has too few points to find an animal's traits");

  const auto residual_at = [&](const Eigen::VectorXd& at) -> std::optional<Eigen::VectorXd> {
    const auto seen = run(at);
    if (!seen) return std::nullopt;
    return off(*seen, points);
  };
  int changes = 0;
  const auto nearest_from = [&](Eigen::VectorXd x, int most) -> std::optional<Nearest> {
    std::optional<Eigen::VectorXd> residual = residual_at(x);
    if (!residual) return std::nullopt;
    const auto own_cost = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& r,
                              double variance) {
      return r.squaredNorm() / variance + at.head(animal_traits).squaredNorm() / (prior * prior);
    };
    Nearest found;
    Eigen::MatrixXd rate(residual->size(), n);
    double damping = first_damping;
    for (int change = 0; change < most && !found.settled; ++change) {
      if (watch) watch(++changes);
      for (Eigen::Index k = 0; k < n; ++k) {
        Eigen::VectorXd near = x;
        near[k] += step[k];
        const auto there = residual_at(near);
        rate.col(k) = there ? Eigen::VectorXd((*there - *residual) / step[k])
                            : Eigen::VectorXd::Zero(residual->size());
      }
      const double variance = residual->squaredNorm() / (numbers - own);
      found.normal = rate.transpose() * rate / variance;
      Eigen::VectorXd gradient = rate.transpose() * *residual / variance;
      found.normal.diagonal().head(animal_traits).array() += 1 / (prior * prior);
      gradient.head(animal_traits) += x.head(animal_traits) / (prior * prior);
      const double before = own_cost(x, *residual, variance);
      found.settled = true;
      for (int trial = 0; trial < most_trials; ++trial) {
        Eigen::MatrixXd damped = found.normal;
        damped.diagonal() *= 1 + damping;
        const Eigen::VectorXd next = x - Eigen::VectorXd(damped.ldlt().solve(gradient));
        const auto there = next.allFinite() ? residual_at(next) : std::nullopt;
        const double after = there ? own_cost(next, *there, variance) : before;
        damping *= after < before ? easing : 1 / easing;
        if (!(after < before)) continue;
        found.settled = before - after < settled_at * before;
        x = next;
        residual = there;
        break;
      }
    }
    found.x = x;
    found.residual = *residual;
    return found;
  };
  std::optional<Nearest> best;
  for (const std::array<double, animal_traits>& first : first_factors) {
    for (int k = 0; k < animal_traits; ++k) start[k] = std::log(first[k]);
    const auto found = nearest_from(start, trial_changes);
    if (found && (!best || found->residual.squaredNorm() < best->residual.squaredNorm()))
      best = found;
  }
  if (!best) throw InputError("no run begins as the film does: check units and scale");
  best = nearest_from(best->x, most_changes);
  const Eigen::MatrixXd spread = best->normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  AnimalFit found;
  found.settled = best->settled;
  found.rms = std::sqrt(best->residual.squaredNorm() / static_cast<double>(points.at.cols()));
  if (const auto seen = run(best->x)) found.moved = moved_by(*seen, points);
  const double wider = std::sqrt(likeness(best->residual, points));
  for (int k = 0; k < animal_traits; ++k) {
    TraitEstimate& trait = found.trait[k];
    const double half =
        ninety * std::hypot(wider * std::sqrt(std::max(spread(k, k), 0.0)), model_error[k]);
    trait = {std::exp(best->x[k]), std::exp(best->x[k] - half), std::exp(best->x[k] + half),
             found.moved > found.rms && 2 * half < std::log(trait_told)};
  }
  return found;
}

}  // namespace hagfish
