// What a step costs, with MuJoCo's beside it in the same process; here its contact and its QP, too.
//   hagfish_benchmarks [--benchmark_...] LOG...
// Each log gives an animal and knotted states of it (start.hpp). Names are SIMULATOR/PART/BODIES.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <utility>

#include "core/log/build_info.hpp"
#include "core/step/rows/dual_problem.hpp"
#include "core/step/rows/row_selection.hpp"
#include "experiments/benchmarks/mujoco_setting.hpp"
#include "experiments/benchmarks/start.hpp"
#include "mujoco_ref/mirror.hpp"

namespace {

using namespace hagfish;

// Steps from a state before a simulation is set back to the next one, so that it stays what it is
// named: nothing pulls MuJoCo's knot along, and of its 58 contacts at 100 bodies 54 are left after
// 10 steps, 47 after 20 and 16 after 50. What a restart costs counts, so both are measured.
constexpr std::array restarts = {10, 100};

void add(const std::string& simulator, const std::string& part, int bodies,
         const std::function<void()>& work) {
  benchmark::RegisterBenchmark(fmt::format("{}/{}/{}", simulator, part, bodies).c_str(),
                               [work](benchmark::State& state) {
                                 for (auto _ : state) work();
                               })
      ->Unit(benchmark::kMicrosecond);
}

/// Whole rounds of `restart` steps, timed a step each, however dear a step is.
void add_rounds(const std::string& simulator, const std::string& part, int bodies, int restart,
                const std::function<void()>& round, double residual = 0) {
  benchmark::RegisterBenchmark(fmt::format("{}/{}:{}/{}", simulator, part, restart, bodies).c_str(),
                               [round, restart, residual](benchmark::State& state) {
                                 while (state.KeepRunningBatch(restart)) round();
                                 state.counters["residual"] = residual;
                               })
      ->Unit(benchmark::kMicrosecond);
}

/// The core's whole step, on and on from one of the states of `start` after the other.
void add_core_step(const std::string& part, const std::shared_ptr<Start>& start,
                   const std::string& back_end, int restart) {
  struct Run {
    std::vector<Simulation> origins;
    Simulation sim;
    StepRecord record;
    std::size_t next = 0;  ///< origin
  };
  auto run = std::make_shared<Run>(Run{start->sims, start->middle(), {}});
  for (Simulation& origin : run->origins) {
    WarmStart warm = origin.solver.warm;
    origin.solver = StepSolver(back_end);
    origin.solver.warm = std::move(warm);
  }
  add_rounds("core", part, start->model.body_count(), restart, [start, run, restart] {
    run->sim = run->origins[run->next++ % run->origins.size()];
    for (int k = 0; k < restart; ++k) {
      take_step(start->model, start->scene, run->sim, run->record);
    }
  });
}

/// mj_step, likewise, of `mirror`. Knotted, it tells how far from converged its solver is.
void add_mujoco_step(const std::string& part, const std::shared_ptr<Start>& start,
                     MujocoModel mirror, double residual, int restart) {
  struct Run {
    MujocoModel mirror;
    std::vector<Eigen::VectorXd> accelerations;  ///< that it starts from in each state
    std::size_t next = 0;                        ///< state
  };
  auto run = std::make_shared<Run>(Run{std::move(mirror), {}});
  mjData& data = *run->mirror.data();
  const int nv = run->mirror.model()->nv;
  for (const Simulation& sim : start->sims) {
    set_state(start->model, sim.now.state, run->mirror);
    mj_forward(run->mirror.model(), &data);
    run->accelerations.emplace_back(Eigen::Map<const Eigen::VectorXd>(data.qacc, nv));
  }
  add_rounds(
      "mujoco", part, start->model.body_count(), restart,
      [start, run, restart] {
        const std::size_t from = run->next++ % start->sims.size();
        set_state(start->model, start->sims[from].now.state, run->mirror);
        std::ranges::copy(run->accelerations[from], run->mirror.data()->qacc_warmstart);
        for (int k = 0; k < restart; ++k) {
          mj_step(run->mirror.model(), run->mirror.data());
        }
      },
      residual);
}

/// A step of the knotted animal, taken apart.
struct Parts {
  explicit Parts(std::shared_ptr<Start> of) : start(std::move(of)), sim(start->middle()) {
    for (Eigen::Matrix3Xd& seen : centre) {
      take_step(start->model, start->scene, sim, record);
      seen = sim.now.observation.kin.centre;
    }
  }
  std::shared_ptr<Start> start;
  Simulation sim;
  StepRecord record;
  std::array<Eigen::Matrix3Xd, 2> centre;  ///< of the bodies, a step apart
  std::size_t pose = 0;
  ContactSearch search;
  ContactSet contacts;
  std::vector<SplineSegment> segments;
  RowColumns columns;
  BoxQp qp;
};

/// The constrained motion of the knotted state, from Eq. 1 assembled, with those of the rows
/// prescribed that `select` says, and the others in a warm QP.
template <class Select>
void add_prescribing(const std::string& name, const std::shared_ptr<Parts>& parts, Select select) {
  struct Run {
    std::vector<Row> rows;
    std::vector<PrescribedVelocity> prescribed;
    Eigen::VectorXd start, base, reaction;
    Eigen::Matrix3Xd centre_velocity;
    Matrix6Xd twist;
    ArticulatedFactor factor;
    std::shared_ptr<BoxQpSolver> solver = make_box_qp_solver("active-set");
    BoxQpSolution solution;
  };
  const auto run = std::make_shared<Run>();
  const Model& model = parts->start->model;
  const StepSolution& step = parts->record.solution;
  std::vector<std::pair<int, std::size_t>> order;  // of the others
  for (std::size_t i = 0; i < step.rows.size(); ++i) {
    Row row = step.rows[i];
    row.prescribed = row.prescribed && select(row);
    if (row.prescribed) {
      run->prescribed.push_back({row.joint()->dof, row.joint()->sign * row.rhs});
    } else {
      order.emplace_back(order_in_step(model, row), i);
    }
  }
  std::ranges::sort(order);
  run->start.resize(static_cast<Eigen::Index>(order.size()));
  for (std::size_t k = 0; k < order.size(); ++k) {
    run->rows.push_back(step.rows[order[k].second]);
    run->start[static_cast<Eigen::Index>(k)] =
        step.lambda[static_cast<Eigen::Index>(order[k].second)];
  }
  add("core", name, model.body_count(), [parts, run] {
    const Model& of = parts->start->model;
    const Kinematics& kin = parts->record.after.observation.kin;
    const StepSystem& system = parts->record.solution.system;
    run->factor.factorise(of, kin, system.op, run->prescribed);
    run->factor.solve(of, kin, system.wrench, system.joint, run->base, run->twist, run->reaction);
    centre_velocities(kin, run->twist, run->centre_velocity);
    assemble_dual(of, kin, run->factor, run->rows, run->base, {run->twist, run->centre_velocity},
                  parts->columns, parts->qp);
    run->solver->solve(parts->qp, run->start, run->solution);
  });
}

void add_core_parts(const std::shared_ptr<Start>& start) {
  const auto parts = std::make_shared<Parts>(start);
  const int n = start->model.body_count();
  add("core", "contact", n, [parts] {  // to and fro, as a search saves its work where nothing moves
    Parts& p = *parts;
    p.pose = 1 - p.pose;
    update_spline(p.start->model, p.centre[p.pose], p.segments);
    find_contacts(p.segments, p.start->scene.contact, 0, p.search, p.contacts);
  });
  add_prescribing("prescribe_nothing", parts, [](const Row&) { return false; });
  add_prescribing("prescribe_head", parts,
                  [](const Row& row) { return row.kind == RowKind::head; });
  add_prescribing("prescribe_all", parts, [](const Row& row) { return row.prescribed; });
  for (const std::string& name : box_qp_solver_names()) {
    const std::shared_ptr<BoxQpSolver> solver = make_box_qp_solver(name);
    add("core", "qp_" + name, n, [parts, solver] {
      benchmark::DoNotOptimize(
          solver->solve(parts->sim.solver.problem().qp, parts->sim.solver.problem().start));
    });
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::AddCustomContext("cpu", cpu_name());
  benchmark::AddCustomContext("compiler", build_compiler());
  benchmark::AddCustomContext("libraries", build_libraries());
  benchmark::AddCustomContext("revision", build_revision());
  try {
    for (int k = 1; k < argc; ++k) {
      const auto knotted = std::make_shared<Start>(knotted_start(argv[k]));
      const auto free = std::make_shared<Start>(free_start(*knotted));
      add_core_parts(knotted);
      for (const int restart : restarts) {
        add_core_step("step_knotted_active-set", knotted, "active-set", restart);
      }
      for (const MujocoSetting& setting : mujoco_settings()) {
        const double residual = mujoco_residual(*knotted, setting, restarts.front());
        for (const int restart : restarts) {
          MujocoModel mirror = mirror_of(*knotted);
          setting.apply(*mirror.model());
          add_mujoco_step("step_knotted:" + setting.name(), knotted, std::move(mirror), residual,
                          restart);
        }
      }
      add_core_step("step_midpoint",
                    std::make_shared<Start>(knotted_start(argv[k], TimeRule::midpoint)),
                    "active-set", restarts.front());
      add_core_step("step_free", free, "active-set", restarts.front());
      add_mujoco_step("step_free", free, mirror_of(*free), 0, restarts.front());
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "hagfish_benchmarks: {}\n", error.what());
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
