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
#include "experiments/film/fit/film_curve.hpp"
#include "experiments/film/fit/film_shape.hpp"

namespace hagfish {
namespace {

constexpr double prior = std::numbers::ln10;  // standard deviation of a factor's logarithm
constexpr double ninety = 1.6449;             // standard deviations to each side of 90 %
// What shapes of so many bodies and stations leave wrong of the logarithms, standard deviations:
// measured where films were made with 150 bodies and fitted with 50, noise aside.
constexpr std::array<double, AnimalFit::traits> model_error = {0.01, 0.06, 0.01};
constexpr int stations = 12;            // of the start
constexpr int most_times = 200;         // of the program by which the film's noise is told
constexpr double longest_step = 0.002;  // s: the third bending mode of the paper's animal takes 0.1
constexpr int trial_changes = 3, most_changes = 30, most_trials = 8;
constexpr double first_damping = 1e-3, easing = 0.2;  // of Levenberg and Marquardt
// Factors to begin with, of stiffness, damping and drag. Where drag and stiffness alone count, what
// they have in common is told by little, and steps from one start stop in a valley.
constexpr std::array<std::array<double, AnimalFit::traits>, 4> first_factors{
    {{1, 1, 1}, {0.2, 0.2, 0.3}, {5, 5, 3}, {0.2, 0.2, 2}}};
// Of the film, that is fitted before all of it: a stiff body beats many times in a long film, and
// steps stop where a wrong number of beats fits best.
constexpr double early_share = 0.25;
// Of a run off the film over shapes off it, where the run is the film's; of films without noise, a
// share of the length, which few bodies leave wrong.
constexpr double most_misfit = 1.3, few_bodies = 5e-4;
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

/// Those of the first `share` of the time.
Points first_part(const Points& points, double share) {
  Points part;
  Eigen::Index count = 0;
  for (std::size_t f = 0; f < points.time.size() && points.time[f] <= share * points.time.back();
       ++f) {
    part.place.push_back(points.place[f]);
    part.time.push_back(points.time[f]);
    count += static_cast<Eigen::Index>(points.place[f].size());
  }
  part.at = points.at.leftCols(count);
  return part;
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
  resolved.model = make_hagfish(resolved.specimen, scene);
  return resolved;
}

/// Runs of the animal from starts and with factors that are the unknowns: logarithms of the
/// factors; bends at the stations, about each axis; their rates; of a free head its twist.
class Runs {
 public:
  Runs(const ResolvedScene& resolved, const Film& film, FilmHead head, const Points& points)
      : scene_(resolved.scene),
        model_(resolved.model),
        points_(points),
        axes_(film.planar ? 1 : 2),
        free_(head == FilmHead::free ? 3 * axes_ : 0) {}

  Eigen::Index size() const { return first_rate() + axes_ * stations + free_; }
  Eigen::Index first_rate() const { return AnimalFit::traits + axes_ * stations; }
  const Model& model() const { return model_; }

  /// Where the film's points are in a run, 3 x points, cm; nothing where it does not last.
  std::optional<Eigen::Matrix3Xd> operator()(const Eigen::VectorXd& x) const {
    Model model = model_;
    for (Hinge& hinge : model.hinges) {
      hinge.stiffness *= std::exp(x[AnimalFit::stiffness]);
      hinge.damping *= std::exp(x[AnimalFit::damping]);
    }
    model.drag.normal *= std::exp(x[AnimalFit::drag]);
    model.drag.tangential *= std::exp(x[AnimalFit::drag]);
    StartSettings start;
    start.bend = rows(x, AnimalFit::traits);
    start.bend_rate = rows(x, first_rate());
    State state = start_state(model, start);
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
      Simulation sim = start_from(model, scene_, "active-set", state, {}, 0);
      StepRecord record;
      State last = state;
      const double h = scene_.time.step;
      const auto look = [&](const StepRecord&, const Simulation& at) {
        const double time = time_of(at, scene_);
        for (; frame < points_.time.size() && points_.time[frame] <= time + 1e-9 * h;) {
          place(last, frame, before);
          place(at.now.state, frame, after);
          const double share = std::clamp((points_.time[frame] - (time - h)) / h, 0.0, 1.0);
          keep((1 - share) * before + share * after);
        }
        last = at.now.state;
      };
      const auto done = [&] { return frame == points_.time.size(); };
      const Status end = drive(model, scene_, sim, record, {look}, done);
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
    for (int j = 0; j < stations; ++j) {
      const double station = static_cast<double>(j) / (stations - 1);
      const double z = x[first + (axes_ - 1) * stations + j] / model_.length();
      const double y = axes_ == 2 ? x[first + j] / model_.length() : 0;
      rows.emplace_back(station, 0, y, z);
    }
    return rows;
  }

  Scene scene_;
  Model model_;
  const Points& points_;
  Eigen::Index axes_, free_;
};

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

/// The least squares: residuals of runs from the film's points, and the prior of the factors.
struct Problem {
  const Runs& run;
  const Points& points;
  double freedom = 0;    ///< numbers that are compared, less those that are fitted
  Eigen::VectorXd step;  ///< of differences, by unknown

  /// Nothing where the run does not last.
  std::optional<Eigen::VectorXd> residual(const Eigen::VectorXd& x) const {
    const auto seen = run(x);
    return seen ? std::optional(off(*seen, points)) : std::nullopt;
  }
  double cost(const Eigen::VectorXd& x, const Eigen::VectorXd& residual, double variance) const {
    return residual.squaredNorm() / variance +
           x.head(AnimalFit::traits).squaredNorm() / (prior * prior);
  }
  /// Rates of the residual by each unknown; 0 where the run beside does not last.
  Eigen::MatrixXd rates(const Eigen::VectorXd& x, const Eigen::VectorXd& residual) const {
    Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(residual.size(), x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      Eigen::VectorXd near = x;
      near[k] += step[k];
      if (const auto there = this->residual(near)) rate.col(k) = (*there - residual) / step[k];
    }
    return rate;
  }
};

/// From `x` on, by at most so many changes; nothing where no run begins there.
std::optional<Nearest> nearest_from(const Problem& problem, const Eigen::VectorXd& x, int most,
                                    const std::function<void()>& watch) {
  const auto begin = problem.residual(x);
  if (!begin) return std::nullopt;
  Nearest at{x, *begin, {}, false};
  double damping = first_damping;
  for (int change = 0; change < most && !at.settled; ++change) {
    watch();
    const Eigen::MatrixXd rate = problem.rates(at.x, at.residual);
    const double variance = at.residual.squaredNorm() / problem.freedom;
    at.normal = rate.transpose() * rate / variance;
    Eigen::VectorXd gradient = rate.transpose() * at.residual / variance;
    at.normal.diagonal().head<AnimalFit::traits>().array() += 1 / (prior * prior);
    gradient.head<AnimalFit::traits>() += at.x.head<AnimalFit::traits>() / (prior * prior);
    const double before = problem.cost(at.x, at.residual, variance);
    at.settled = true;
    for (int trial = 0; trial < most_trials; ++trial) {
      Eigen::MatrixXd damped = at.normal;
      damped.diagonal() *= 1 + damping;
      const Eigen::VectorXd next = at.x - Eigen::VectorXd(damped.ldlt().solve(gradient));
      const auto there = next.allFinite() ? problem.residual(next) : std::nullopt;
      const double after = there ? problem.cost(next, *there, variance) : before;
      damping *= after < before ? easing : 1 / easing;
      if (!(after < before)) continue;
      at.settled = before - after < settled_at * before;
      at.x = next;
      at.residual = *there;
      break;
    }
  }
  return at;
}

}  // namespace

AnimalFit fit_animal(const ResolvedScene& resolved, const Film& film, FilmHead head,
                     const std::function<void(int)>& watch) {
  const double lasts = film.frames.back().time - film.frames.front().time;
  const ResolvedScene scene = passive(resolved, head, lasts + longest_step);
  const int times = std::min(static_cast<int>(film.frames.size()), most_times);
  const FilmFit fit = fit_film(scene.model, film, head, times, stations);
  const Points points = points_used(film, fit);
  const Runs run(scene, film, head, points);
  const Model& model = run.model();
  const auto none = [&](double Hinge::*of) {
    return std::ranges::all_of(model.hinges, [&](const Hinge& h) { return h.*of == 0; });
  };
  if (none(&Hinge::stiffness) || none(&Hinge::damping) || model.drag.normal == 0) {
    throw InputError("the scene has no stiffness, damping or drag to scale");
  }
  Eigen::VectorXd start = Eigen::VectorXd::Zero(run.size());
  Eigen::VectorXd step = Eigen::VectorXd::Constant(run.size(), rate_step);
  step.head<AnimalFit::traits>().setConstant(factor_step);
  step.segment(AnimalFit::traits, run.first_rate() - AnimalFit::traits).setConstant(bend_step);
  // About Y, unless the film is flat, and about Z, at the program's stations.
  const int first_axis = film.planar ? 1 : 0;
  for (int axis = first_axis; axis < 2; ++axis) {
    start.segment<stations>(AnimalFit::traits + (axis - first_axis) * stations) =
        fit.program.value.front().row(axis).transpose();
  }
  const double dimensions = film.planar ? 2 : 3, motion = film.planar ? 3 : 6;
  const double fitted = static_cast<double>(run.size()) + motion;
  const auto compared = [&](const Points& of) {
    return dimensions * static_cast<double>(of.at.cols());
  };
  if (compared(points) < 2 * fitted) {
    throw InputError("has too few points to find an animal's traits");
  }
  int changes = 0;
  const auto count = [&] {
    if (watch) watch(++changes);
  };
  std::vector<Eigen::VectorXd> starts;
  for (const auto& first : first_factors) {
    for (int k = 0; k < AnimalFit::traits; ++k) start[k] = std::log(first[k]);
    starts.push_back(start);
  }
  const auto best_of = [&](const Runs& runs, const Points& of) {
    const Problem problem{runs, of, compared(of) - fitted, step};
    std::optional<Nearest> best;
    for (const Eigen::VectorXd& x : starts) {
      const auto found = nearest_from(problem, x, trial_changes, count);
      if (found && (!best || found->residual.squaredNorm() < best->residual.squaredNorm())) {
        best = found;
      }
    }
    if (best) best = nearest_from(problem, best->x, most_changes, count);
    return best;
  };
  if (const Points early = first_part(points, early_share); compared(early) >= 2 * fitted) {
    const Runs early_run(scene, film, head, early);
    if (const auto found = best_of(early_run, early)) starts.push_back(found->x);
  }
  const std::optional<Nearest> best = best_of(run, points);
  if (!best) throw InputError("no run begins as the film does: check units and scale");
  AnimalFit found;
  found.scale = fit.scale;
  found.shapes = fit.rms;
  found.settled = best->settled;
  found.rms = std::sqrt(best->residual.squaredNorm() / static_cast<double>(points.at.cols()));
  found.moves_alike = found.rms < most_misfit * fit.rms + few_bodies * model.length();
  if (const auto seen = run(best->x)) found.moved = moved_by(*seen, points);
  const Eigen::Index n = run.size();
  const Eigen::MatrixXd spread = best->normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  const double wider = std::sqrt(likeness(best->residual, points));
  for (int k = 0; k < AnimalFit::traits; ++k) {
    const double x = best->x[k];
    const double half =
        ninety * std::hypot(wider * std::sqrt(std::max(spread(k, k), 0.0)), model_error[k]);
    found.trait[k] = {std::exp(x), std::exp(x - half), std::exp(x + half),
                      found.moved > found.rms && 2 * half < std::log(trait_told)};
  }
  return found;
}

}  // namespace hagfish
