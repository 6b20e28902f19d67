#include "experiments/film/film_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/input/input_text.hpp"
#include "core/knot/knot.hpp"
#include "core/knot/writhe.hpp"
#include "core/run/simulation.hpp"
#include "core/scene/interpolation.hpp"
#include "experiments/design/program_fit.hpp"
#include "experiments/film/fit/film_curve.hpp"
#include "experiments/film/fit/film_shape.hpp"

namespace hagfish {
namespace {

constexpr int doublings = 6;          // of the stiffness, that are tried
constexpr double compare_each = 0.1;  // s
/// What is its own mirror image has a writhe of about 0: those of right-handed knots are above 3.
constexpr double least_writhe = 2;
constexpr int centreline_points = 101;

Eigen::VectorXd values_at(const CurvatureProgram& program, double time) {
  const auto n = static_cast<Eigen::Index>(program.station.size());
  const Bracket at = bracket_of(program.time, time);
  Eigen::VectorXd values(2 * n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      values[axis * n + j] = value_at(at, [&](std::size_t k) { return program.value[k](axis, j); });
    }
  }
  return values;
}

/// Squares of the bodies' distances from a shape, the head where it is as near as can be.
double squares_off(const Kinematics& kin, const ProgramShape& shape, const Eigen::VectorXd& values,
                   const std::vector<double>& places, bool clamped) {
  const Eigen::Matrix3Xd own = shape.points(values, places);
  const Eigen::Matrix3Xd there = clamped ? own : nearest_motion(own, kin.centre).of(own);
  return (kin.centre - there).squaredNorm();
}

}  // namespace

FilmedKnot knot_of(const Eigen::Matrix3Xd& points, const KnotSettings& settings) {
  FilmedKnot seen{"0_1", Hand::any};
  try {
    seen.name = knot_name(knot_type(points, settings).type);
  } catch (const std::exception&) {  // a shape that passes through itself has none
    return seen;
  }
  const double turns = writhe(points);
  if (seen.name != "0_1" && std::abs(turns) > least_writhe) {
    seen.hand = turns > 0 ? Hand::right : Hand::left;
  }
  return seen;
}

FilmedKnot knot_of(const Model& model, const CurvatureProgram& program, std::size_t time,
                   const KnotSettings& settings) {
  const ProgramShape shape(model, program.station, false);
  return knot_of(shape.points(values_at(program, program.time[time]), even(centreline_points, 1)),
                 settings);
}

std::vector<Eigen::Vector4d> first_bends(const Model& model, const CurvatureProgram& program) {
  std::vector<Eigen::Vector4d> bends;
  const auto rounded = [](double x) { return *finite_number(fmt::format("{:.6g}", x)); };
  for (std::size_t j = 0; j < program.station.size(); ++j) {
    const Eigen::Vector3d value =
        program.value.front().col(static_cast<Eigen::Index>(j)) / model.length();
    bends.emplace_back(rounded(program.station[j]), rounded(value[2]), rounded(value[0]),
                       rounded(value[1]));
  }
  return bends;
}

ResolvedScene scene_of_film(ResolvedScene base, const CurvatureProgram& program,
                            const FilmedKnot& knot, double stiffness) {
  Scene& scene = base.scene;
  scene.script.curvature = program;
  scene.active.stiffness = stiffness;
  scene.controller.tighten_from = program.time.back();
  scene.start.bend = first_bends(base.model, program);
  if (knot.name != "0_1") {
    scene.expect.knot = knot.name;
    scene.expect.hand = knot.hand;
  }
  return base;
}

std::vector<FilmTrial> try_stiffness(const ResolvedScene& base, const CurvatureProgram& program,
                                     const FilmedKnot& knot, const Watcher& watch) {
  std::vector<FilmTrial> trials;
  int failed = 0;
  for (int k = 0; k < doublings && failed < 2; ++k) {
    const double stiffness = std::ldexp(base.scene.active.stiffness, k);
    const ResolvedScene resolved = scene_of_film(base, program, knot, stiffness);
    const Scene& scene = resolved.scene;
    const Model& model = resolved.model;
    const ProgramShape shape(model, program.station, false);
    std::vector<double> places;
    for (int b = 0; b < model.body_count(); ++b) places.push_back((b + 0.5) / model.body_count());
    FilmTrial trial{stiffness, false, {}, 0};
    double squares = 0, count = 0, next = 0;
    try {
      Simulation sim = start(model, scene, "active-set");
      StepRecord record;
      const auto compare = [&](const StepRecord& step, const Simulation&) {
        if (step.time < next) return;
        squares += squares_off(kinematics(model, step.after.state), shape,
                               values_at(program, step.time), places, scene.clamp_head);
        count += static_cast<double>(places.size());
        next += compare_each;
      };
      const auto formed = [&] {
        return time_of(sim, scene) >= program.time.back() || sim.controller.phase != Phase::form;
      };
      const Status end = drive(model, scene, sim, record, {compare, watch}, formed);
      if (!end.ok() && end.outcome != Outcome::stopped) throw StepError(end);
      const Kinematics kin = kinematics(model, sim.now.state);
      trial.knot = knot_of(kin.centre, scene.knot);
      trial.rms = std::sqrt(squares / std::max(count, 1.0));
      trial.lasted = std::isfinite(trial.rms);
    } catch (const std::exception&) {  // it does not last
    }
    failed = trial.lasted ? 0 : failed + 1;
    trials.push_back(trial);
  }
  return trials;
}

std::optional<FilmTrial> best_of(const std::vector<FilmTrial>& trials, const FilmedKnot& knot) {
  std::optional<FilmTrial> best;
  const auto ties = [&](const FilmTrial& trial) {
    return trial.knot.name == knot.name && (knot.hand == Hand::any || trial.knot.hand == knot.hand);
  };
  for (const FilmTrial& trial : trials) {
    if (!trial.lasted) continue;
    if (!best || (ties(trial) != ties(*best) ? ties(trial) : trial.rms < best->rms)) best = trial;
  }
  return best;
}

}  // namespace hagfish
