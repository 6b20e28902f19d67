#include "experiments/python/python_simulation.hpp"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "core/log/coordinate_names.hpp"
#include "core/log/energy_losses.hpp"
#include "experiments/program/run_header.hpp"
#include "experiments/program/scene_argument.hpp"

namespace py = pybind11;

namespace hagfish {
namespace {

/// Steps from one look at Python's signals to the next.
constexpr int signal_stride = 64;

ResolvedScene resolve(const PythonRun& run) {
  std::vector<std::string> set = run.set;
  if (!run.law.is_none()) set.emplace_back("controller.law=own");
  return scene_argument(run.scene, set);
}

/// `resolved` with other settings.
ResolvedScene changed(const ResolvedScene& resolved, const std::vector<std::string>& set) {
  if (set.empty()) return resolved;
  return read_scene_text(scene_to_toml(resolved.scene, resolved.specimen), "copy", set);
}

}  // namespace

PythonSimulation::PythonSimulation(const PythonRun& run)
    : resolved(resolve(run)),
      model(make_hagfish(resolved.specimen, resolved.scene)),
      sim(start(model, resolved.scene, run.qp)),
      control(record.control, model.nv()),
      scene_(resolved.scene),
      law_(run.law) {
  hold_views();
  if (!run.log.empty()) {
    log_.emplace(run.log, run.force, log_header(resolved, model, run.qp, run.command), model,
                 resolved.scene);
  }
}

PythonSimulation::PythonSimulation(const PythonSimulation& other, const py::object& law,
                                   const std::vector<std::string>& set)
    : resolved(changed(other.resolved, set)),
      model(make_hagfish(resolved.specimen, resolved.scene)),
      sim(other.sim),
      control(record.control, model.nv()),
      scene_(resolved.scene),
      law_(law.is_none() ? other.law_ : law) {
  if (!set.empty()) change_scene(model, other.resolved.scene, resolved.scene, sim);
  if (!law.is_none()) resolved.scene.controller.law = own_law;
  hold_views();
}

/// Views of forces are of vectors that have their length from the start.
void PythonSimulation::hold_views() {
  for (const RowKind kind : row_kinds) record.solution.force[kind].setZero(model.nv());
  record.solution.active_torque.setZero(model.nv());
  show();
}

void PythonSimulation::show() {
  q = sim.now.state.q;
  qdot = sim.now.state.qdot;
  position = sim.now.observation.kin.centre;
  velocity = sim.now.observation.kin.centre_velocity;
}

void PythonSimulation::ask_python() {
  const py::gil_scoped_acquire gil;
  control.begin();
  const py::object self = py::cast(this);
  law_(self, py::cast(&control, py::return_value_policy::reference_internal, self));
  control.end();
}

void PythonSimulation::take() {
  if (closed_) throw std::invalid_argument("the log of this run is closed");
  try {
    take_step(model, scene_, sim, record);
  } catch (const std::exception& error) {
    failure_ = fmt::format("{} at step {} (t = {:.4f} s, {})", error.what(), sim.step, time(),
                           phase_name(record.controller.phase));
    throw;
  }
  failure_.clear();
  if (log_) {
    const auto elapsed = std::chrono::steady_clock::now() - begin_;
    log_->write(record, sim, std::chrono::duration<double>(elapsed).count());
  }
  show();
}

/// By the scene's law, or the run's own.
void PythonSimulation::take_law() {
  scene_.controller.law = resolved.scene.controller.law;
  sim.law = {};
  if (!law_.is_none()) {
    sim.law = [this](const Situation& at, Eigen::VectorXd&, Control& of_step) {
      paper_law(at, of_step);
      ask_python();  // `control` is of the record, as `of_step` is
    };
  }
}

void PythonSimulation::step() {
  take_law();
  const py::gil_scoped_release no_gil;
  take();
}

void PythonSimulation::step_by(PythonControl& asked) {
  if (log_ && resolved.scene.controller.law != own_law) {
    throw std::invalid_argument(
        "a step was given a control, but the log says that the scene's law has it: "
        R"(set={"controller.law": "own"})");
  }
  asked.end();
  scene_.controller.law = own_law;
  sim.law = [&asked](const Situation&, Eigen::VectorXd&, Control& of_step) {
    if (&of_step != asked.control) of_step = *asked.control;
  };
  const py::gil_scoped_release no_gil;
  take();
}

void PythonSimulation::run_while(const std::function<bool()>& wanted) {
  take_law();
  const py::gil_scoped_release no_gil;
  for (int n = 1; !over() && wanted(); ++n) {
    take();
    if (n % signal_stride == 0) {
      const py::gil_scoped_acquire gil;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
  }
}

void PythonSimulation::close() {
  if (!log_) return;
  closed_ = true;
  const std::string status = over()             ? "complete"
                             : failure_.empty() ? fmt::format("failed: closed at step {}", sim.step)
                                                : "failed: " + failure_;
  log_->finish(status, sim);
  log_.reset();
}

namespace {

/// "form, tighten, ... or free".
template <class Entry, std::size_t n>
std::string one_of(const std::array<Entry, n>& table) {
  std::string words;
  for (const Entry& entry : table) {
    words += words.empty() ? "" : (&entry == &table.back() ? " or " : ", ");
    words += entry.name;
  }
  return words;
}

/// `until` of run(): None, a time, the name of a phase or a callable.
void run_until(PythonSimulation& run, const py::object& self, const py::object& until) {
  if (until.is_none()) {
    run.run_while([] { return true; });
  } else if (py::isinstance<py::str>(until)) {
    const auto name = until.cast<std::string>();
    const auto* const last = std::ranges::find(phase_table, name, &PhaseEntry::name);
    if (last == phase_table.end()) {
      throw py::value_error(fmt::format("until = {}: {}", name, one_of(phase_table)));
    }
    run.run_while([&run, order = phase_order(last->value)] {
      return phase_order(run.sim.controller.phase) <= order;
    });
  } else if (PyCallable_Check(until.ptr()) != 0) {
    run.run_while([&] {
      const py::gil_scoped_acquire gil;
      return !until(self).cast<bool>();
    });
  } else {
    // Half a step of slack: the time of a step is a product.
    const double end = until.cast<double>() - 0.5 * run.resolved.scene.time.step;
    run.run_while([&run, end] { return run.time() < end; });
  }
}

std::string text_of(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  return py::str(value);
}

/// Keys and values as --set has them.
std::vector<std::string> settings(const py::dict& set) {
  std::vector<std::string> list;
  for (const auto& [key, value] : set) list.push_back(text_of(key) + "=" + text_of(value));
  return list;
}

std::unique_ptr<PythonSimulation> begin(const py::object& scene, const py::dict& set,
                                        const std::string& qp, const py::object& law,
                                        const py::object& log, bool force) {
  const auto path = [](const py::object& of) {
    return py::module_::import("os").attr("fspath")(of).cast<std::string>();
  };
  PythonRun run{path(scene), settings(set), qp, law, log.is_none() ? "" : path(log), force, ""};
  run.command =
      fmt::format("hagfish.Simulation({}, set={}{})", std::string(py::repr(py::str(run.scene))),
                  std::string(py::repr(set)), law.is_none() ? "" : ", law=...");
  return std::make_unique<PythonSimulation>(run);
}

py::dict forces(const py::object& self) {
  auto& run = self.cast<PythonSimulation&>();
  StepSolution& step = run.record.solution;
  py::dict views;
  const auto nv = static_cast<py::ssize_t>(run.model.nv());
  for (const RowKindEntry& kind : row_kind_table) {
    views[kind.name] = view(self, step.force[kind.value].data(), {nv}, false);
  }
  views["active"] = view(self, step.active_torque.data(), {nv}, false);
  views["tip"] = view(self, step.tip.data(), {3}, false);
  return views;
}

py::dict energies(const PythonSimulation& run) {
  const EnergyLedger& ledger = run.sim.ledger;
  py::dict e;
  e["kinetic"] = ledger.kinetic;
  e["elastic"] = ledger.elastic;
  e["gravity"] = ledger.gravity;
  e["work_tip"] = ledger.work_tip;
  e["work_active"] = ledger.work_active;
  for (const RowKindEntry& kind : row_kind_table) {
    e[(std::string("work_") + kind.name).c_str()] = ledger.work[kind.value];
  }
  for (const EnergyLoss& loss : energy_losses) e[loss.name] = ledger.*loss.member;
  e["integrator_error"] = ledger.integrator_error();
  return e;
}

py::dict momenta(const PythonSimulation& run) {
  const MomentumLedger& ledger = run.sim.momentum;
  py::dict m;
  const auto put = [&m](const char* name, const Momentum& of) {
    Eigen::Matrix<double, 2, 3> rows;
    rows << of.linear.transpose(), of.angular.transpose();
    m[name] = rows;
  };
  put("now", ledger.momentum);
  put("initial", ledger.initial);
  put("drag", ledger.drag);
  put("outside", ledger.outside);
  put("integrator", ledger.integrator);
  put("given_back", ledger.given_back);
  return m;
}

std::vector<std::string> dof_names(const Model& model) {
  std::vector<std::string> names;
  for (int k = 0; k < model.nv(); ++k) names.push_back(dof_name(model, k));
  return names;
}

/// A view of the storage of a simulation that `member` is.
template <auto member>
py::array_t<double> shown(const py::object& self) {
  auto& values = self.cast<PythonSimulation&>().*member;
  std::vector<py::ssize_t> shape{values.cols(), values.rows()};  // row by row in numpy
  if (shape[0] == 1) shape.erase(shape.begin());
  return view(self, values.data(), shape, false);
}

}  // namespace

void declare_simulation(py::module_& module) {
  using Run = PythonSimulation;
  const auto knot_end = [](double KnotSpan::*end) {
    return [end](const Run& r) -> std::optional<double> {
      const auto span = knot_span(r.sim.controller);
      return span ? std::optional((*span).*end) : std::nullopt;
    };
  };
  py::class_<Run>(module, "Simulation",
                  R"(A run of a scene, step by step, as `hagfish run` takes it.

Arrays are views that show the present state at any time: take them once. They are read-only. Units are cm, g, s,
rad, dyn. nq = 7 + hinges, nv = 6 + hinges, as MuJoCo's qpos and qvel.)")
      .def(
          py::init(&begin), py::arg("scene") = "table1", py::kw_only(), py::arg("set") = py::dict(),
          py::arg("qp") = "active-set", py::arg("law") = py::none(), py::arg("log") = py::none(),
          py::arg("force") = false,
          R"(`scene`: a built-in scene's name or a file. `set`: keys and values, as --set. `qp`: QP back end. `law`: a control
law of your own, called as law(simulation, control) at the start of each step with the paper's control, which it
changes. `log`: a file to write; `force` replaces one that is there. Raises InputError, FileError.)")
      .def(
          "step",
          [](Run& r, PythonControl* given) { given == nullptr ? r.step() : r.step_by(*given); },
          py::arg("control") = py::none(),
          "Takes a step, by the scene's law, by `law`, or as `control` says. Raises StepError, "
          "after which the run is as it was before.")
      .def(
          "run",
          [](const py::object& self, const py::object& until) {
            run_until(self.cast<Run&>(), self, until);
            return self;
          },
          py::arg("until") = py::none(),
          "Steps until a time (s), the end of a phase by its name, or until(simulation) is true; "
          "or the scene is over. Returns the simulation.")
      .def("close", &Run::close, "Ends the log; its status is complete where the scene is over.")
      .def(
          "copy",
          [](const Run& r, const py::object& law, const py::dict& set) {
            return std::make_unique<Run>(r, law, settings(set));
          },
          py::arg("law") = py::none(), py::kw_only(), py::arg("set") = py::dict(),
          "A simulation that goes on from here independently, without a log; by `law` where given, "
          "and with other settings by `set`, as `hagfish branch` has them.")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](Run& r, const py::args&) { r.close(); })
      .def(
          "control", [](const Run& r) { return std::make_unique<PythonControl>(r.model.nv()); },
          "A Control that asks for nothing but a clamped head.")
      .def_property_readonly(
          "q", &shown<&Run::q>,
          "(nq,) view: root position, cm, and quaternion wxyz; hinge angles, rad")
      .def_property_readonly("qdot", &shown<&Run::qdot>,
                             "(nv,) view: root velocity, cm/s, and rate, rad/s; hinge rates, rad/s")
      .def_property_readonly("position", &shown<&Run::position>,
                             "(bodies, 3) view: centres of the bodies, cm, world")
      .def_property_readonly("velocity", &shown<&Run::velocity>,
                             "(bodies, 3) view: their velocities, cm/s, world")
      .def_property_readonly("forces", &forces,
                             "views of the last step's generalised forces by name, (nv,), dyn and "
                             "dyn cm, of all kinds "
                             "of rows and active; and tip (3,), dyn")
      .def_property_readonly(
          "contacts", [](const Run& r) { return r.sim.now.observation.contact.contacts; },
          "list of Contact within contact.margin, a copy, sorted from the head")
      .def_property_readonly(
          "first_contact", [](const Run& r) { return r.sim.controller.ends.first; },
          "Contact that is the knot's first one, or None")
      .def_property_readonly(
          "last_contact", [](const Run& r) { return r.sim.controller.ends.last; },
          "Contact that is the knot's last one, or None")
      .def_property_readonly("time", &Run::time, "s")
      .def_property_readonly(
          "steps", [](const Run& r) { return r.sim.step; }, "steps taken")
      .def_property_readonly(
          "phase", [](const Run& r) { return phase_name(r.sim.controller.phase); },
          one_of(phase_table).c_str())
      .def_property_readonly(
          "clamped", [](const Run& r) { return r.record.control.clamp_head; },
          "whether the head was held in the last step")
      .def_property_readonly(
          "knot", [](const Run& r) { return knot_name(r.sim.controller.knot.type); },
          "type of the knot as last seen: 0_1 for none")
      .def_property_readonly("head_end", knot_end(&KnotSpan::head_end),
                             "arc length of the knot's first contact from the head, cm, or None")
      .def_property_readonly("tail_end", knot_end(&KnotSpan::tail_end),
                             "arc length of its last contact, cm, or None")
      .def_property_readonly("finished", &Run::over, "whether the scene is over")
      .def_property_readonly("energy", &energies, "the energy ledger by name, erg")
      .def_property_readonly(
          "momentum", &momenta,
          "the momentum ledger by name, each (2, 3): linear, dyn s, and angular about the centre "
          "of "
          "mass, dyn cm s; world. What the integrator makes is integrator + given_back")
      .def_property(
          "memory", [](const Run& r) { return r.sim.controller.memory; },
          [](Run& r, const Eigen::VectorXd& memory) { r.sim.controller.memory = memory; },
          "(any,) copy: numbers that a law keeps from step to step, which checkpoints save")
      .def_property_readonly(
          "warnings", [](const Run& r) { return r.record.warnings; },
          "list of what the last step was warned of")
      .def_property_readonly(
          "h", [](const Run& r) { return r.resolved.scene.time.step; }, "time step, s")
      .def_property_readonly(
          "scene",
          [](const Run& r) { return scene_to_toml(r.resolved.scene, r.resolved.specimen); },
          "the whole scene as TOML")
      .def_property_readonly("bodies", [](const Run& r) { return r.model.body_count(); })
      .def_property_readonly("nq", [](const Run& r) { return r.model.nq(); })
      .def_property_readonly("nv", [](const Run& r) { return r.model.nv(); })
      .def_property_readonly(
          "dof_names", [](const Run& r) { return dof_names(r.model); }, "list of nv names");
}

}  // namespace hagfish
