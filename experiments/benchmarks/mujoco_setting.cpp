#include "experiments/benchmarks/mujoco_setting.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mujoco_ref/mirror.hpp"

namespace hagfish {
namespace {

// In MuJoCo's order of mjtSolver.
constexpr std::array solvers = {std::pair{"pgs", mjSOL_PGS}, std::pair{"cg", mjSOL_CG},
                                std::pair{"newton", mjSOL_NEWTON}};
constexpr double default_tolerance = 1e-8;
constexpr double loose_tolerance = 1e-4;
// Far more than Newton takes from any state, which is some ten.
constexpr int reference_iterations = 1000;

using Accelerations = Eigen::Map<const Eigen::VectorXd>;

double energy_norm(const mjModel& model, const mjData& data, const Eigen::VectorXd& v) {
  Eigen::VectorXd momentum(v.size());
  mj_mulM(&model, &data, momentum.data(), v.data());
  return std::sqrt(v.dot(momentum));
}

}  // namespace

std::string MujocoSetting::name() const {
  return fmt::format("{}:{}:{:g}", solver, jacobian, tolerance);
}

void MujocoSetting::apply(mjModel& model) const {
  model.opt.solver =
      std::ranges::find(solvers, solver, [](const auto& s) { return s.first; })->second;
  model.opt.jacobian = jacobian == "dense" ? mjJAC_DENSE : mjJAC_SPARSE;
  model.opt.tolerance = tolerance;
}

std::vector<MujocoSetting> mujoco_settings() {
  std::vector<MujocoSetting> settings;
  for (const auto& [solver, number] : solvers) {
    for (const char* jacobian : {"dense", "sparse"}) {
      for (const double tolerance : {default_tolerance, loose_tolerance}) {
        settings.push_back({solver, jacobian, tolerance});
      }
    }
  }
  return settings;
}

double mujoco_residual(const Start& start, const MujocoSetting& setting, int steps) {
  MujocoModel run = mirror_of(start);
  setting.apply(*run.model());
  set_state(start.model, start.middle().now.state, run);
  MujocoModel seen = mirror_of(start);  // the state of `run`, stepped no further
  setting.apply(*seen.model());
  MujocoModel exact = mirror_of(start);
  exact.model()->opt.solver = mjSOL_NEWTON;
  exact.model()->opt.tolerance = 0;
  exact.model()->opt.iterations = reference_iterations;
  double worst = 0;
  for (int k = 0; k < steps; ++k) {
    for (MujocoModel* other : {&seen, &exact}) {
      const int nv = run.model()->nv;
      std::copy_n(run.data()->qpos, run.model()->nq, other->data()->qpos);
      std::copy_n(run.data()->qvel, nv, other->data()->qvel);
      std::copy_n(run.data()->qacc_warmstart, nv, other->data()->qacc_warmstart);
      mj_forward(other->model(), other->data());
    }
    const int nv = run.model()->nv;
    const Accelerations found(seen.data()->qacc, nv);
    const Accelerations wanted(exact.data()->qacc, nv);
    const Accelerations unconstrained(exact.data()->qacc_smooth, nv);
    worst = std::max(worst, energy_norm(*exact.model(), *exact.data(), found - wanted) /
                                energy_norm(*exact.model(), *exact.data(), unconstrained - wanted));
    mj_step(run.model(), run.data());
  }
  return worst;
}

}  // namespace hagfish
