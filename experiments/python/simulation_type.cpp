#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <cmath>

#include "core/log/coordinate_names.hpp"
#include "core/log/ledger_columns.hpp"
#include "core/log/means/moment_means.hpp"
#include "experiments/python/begun.hpp"
#include "experiments/python/python_arguments.hpp"
#include "experiments/python/python_simulation.hpp"

namespace py = pybind11;

namespace hagfish {
namespace {

py::dict forces(const py::object& self) {
  auto& run = self.cast<PythonSimulation&>();
  run.require_readable();
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

py::dict moments(const PythonSimulation& run) {
  run.require_readable();
  JointMoments of = no_moments(run.model);
  if (run.sim.step > 0) add_moments(run.model, run.resolved.scene.time, run.record, of);
  py::dict named;
  for (const RowKindEntry& kind : row_kind_table) {
    if (kind.value != RowKind::head) named[kind.name] = of.of_rows[kind.value].transpose().eval();
  }
  named["active"] = of.active.transpose().eval();
  return named;
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
  for (const EnergyColumn& loss : energy_losses) e[loss.name] = ledger.*loss.member;
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

/// None before the knot slides.
py::object slide_of(const PythonSimulation& run) {
  const bool back = run.sim.controller.phase == Phase::reverse;
  const Slide slide = back ? run.slides.way_back() : run.slides.slide();
  if (std::isnan(slide.leading_way)) return py::none();
  py::dict found;
  found["name"] = slide_name(slide);
  found["leading_way"] = slide.leading_way;
  found["trailing_way"] = slide.trailing_way;
  found["taper_asks"] = slide.taper_asks;
  found["curvature_travel"] = slide.travel;
  found["curvature_correlation"] = slide.correlation;
  found["share"] = slide.share();
  return found;
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

/// `get` of a simulation that no other thread has at work.
template <class Get>
auto readable(Get get) {
  return [get](const PythonSimulation& run) {
    run.require_readable();
    return get(run);
  };
}

void take_step_of(PythonSimulation& run, const py::object& control) {
  if (control.is_none()) {
    run.step();
  } else if (py::isinstance<PythonControl>(control)) {
    run.step_by(control.cast<PythonControl&>());
  } else {
    throw py::type_error("control = " + std::string(py::repr(control)) + ": a Control or None");
  }
}

std::unique_ptr<PythonSimulation> copy_of(const PythonSimulation& run, const py::object& law,
                                          const py::object& set) {
  run.require_readable();
  require_law(law);
  return std::make_unique<PythonSimulation>(run, law, settings(set));
}

/// Python's collector of garbage sees a law, which may hold the simulation.
void show_to_collector(PyHeapTypeObject* heap) {
  PyTypeObject& type = heap->ht_type;
  type.tp_flags |= Py_TPFLAGS_HAVE_GC;
  type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) {
    Py_VISIT(Py_TYPE(self));
    if (has_begun(self)) Py_VISIT(py::handle(self).cast<PythonSimulation&>().law().ptr());
    return 0;
  };
  type.tp_clear = [](PyObject* self) {
    if (has_begun(self)) py::handle(self).cast<PythonSimulation&>().law() = py::none();
    return 0;
  };
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
rad, dyn. nq = 7 + hinges, nv = 6 + hinges, as MuJoCo's qpos and qvel.)",
                  py::custom_type_setup(&show_to_collector))
      .def(
          py::init([](const py::object& scene, const py::object& set, const py::object& qp,
                      const py::object& law, const py::object& log, bool force) {
            return std::make_unique<Run>(python_run(scene, set, qp, law, log, force));
          }),
          py::arg("scene") = "table1", py::kw_only(), py::arg("set") = py::dict(),
          py::arg("qp") = "active-set", py::arg("law") = py::none(), py::arg("log") = py::none(),
          py::arg("force") = false,
          R"(`scene`: a built-in scene's name or a file. `set`: keys and values, as --set. `qp`: QP back end. `law`: a control
law of your own, called as law(simulation, control) at the start of each step with the paper's control, which it
changes. `log`: a file to write; `force` replaces one that is there. Raises InputError, FileError.)")
      .def("step", &take_step_of, py::arg("control") = py::none(),
           "Takes a step, by the scene's law, by `law`, or as `control` says. Raises StepError, "
           "after which the run is as it was before.")
      .def(
          "run",
          [](const py::object& self, const py::object& until) {
            run_until(self.cast<Run&>(), self, until);
            return self;
          },
          py::arg("until") = py::none(),
          "Steps to the first step at or past a time (s), to the end of a phase by its name, or "
          "until(simulation) is true; or the scene is over. Returns the simulation.")
      .def("close", &Run::close, "Ends the log; its status is complete where the scene is over.")
      .def(
          "copy", &copy_of, py::arg("law") = py::none(), py::kw_only(), py::arg("set") = py::dict(),
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
      .def_property_readonly("moments", &moments,
                             "the last step's moments about each joint by name, (bodies, 3), dyn "
                             "cm, in axes halfway through the joint")
      .def_property_readonly(
          "contacts", readable([](const Run& r) { return r.sim.now.observation.contact.contacts; }),
          "list of Contact within contact.margin, a copy, sorted from the head")
      .def_property_readonly("first_contact",
                             readable([](const Run& r) { return r.sim.controller.ends.first; }),
                             "Contact that is the knot's first one, or None")
      .def_property_readonly("last_contact",
                             readable([](const Run& r) { return r.sim.controller.ends.last; }),
                             "Contact that is the knot's last one, or None")
      .def_property_readonly("time", &Run::time, "s")
      .def_property_readonly(
          "steps", [](const Run& r) { return r.sim.step; }, "steps taken")
      .def_property_readonly(
          "phase", [](const Run& r) { return phase_name(r.sim.controller.phase); },
          phase_names().c_str())
      .def_property_readonly("clamped",
                             readable([](const Run& r) { return r.record.control.clamp_head; }),
                             "whether the head was held in the last step")
      .def_property_readonly(
          "knot", readable([](const Run& r) { return knot_name(r.sim.controller.knot.type); }),
          "type of the knot as last seen: 0_1 for none")
      .def_property_readonly("head_end", readable(knot_end(&KnotSpan::head_end)),
                             "arc length of the knot's first contact from the head, cm, or None")
      .def_property_readonly("tail_end", readable(knot_end(&KnotSpan::tail_end)),
                             "arc length of its last contact, cm, or None")
      .def_property_readonly(
          "slide", readable(&slide_of),
          "the slide so far, or the way back while it lasts, or None. name: \"slides by both "
          "ends\" "
          "or what it is instead; ways of the knot's leading and trailing end and of the body's "
          "curvature, and what the body's taper asks of the trailing end, cm; the least "
          "correlation "
          "of the curvature; share: 1 or more where all moves alike")
      .def_property_readonly("finished", &Run::over, "whether the scene is over")
      .def_property_readonly("energy", readable(&energies), "the energy ledger by name, erg")
      .def_property_readonly(
          "momentum", readable(&momenta),
          "the momentum ledger by name, each (2, 3): linear, dyn s, and angular about the centre "
          "of "
          "mass, dyn cm s; world. What the integrator makes is integrator + given_back")
      .def_property(
          "memory", readable([](const Run& r) { return r.sim.controller.memory; }),
          [](Run& r, const Eigen::VectorXd& memory) {
            r.require_readable();
            r.sim.controller.memory = memory;
          },
          "(any,) copy: numbers that a law keeps from step to step")
      .def_property_readonly("warnings", readable([](const Run& r) { return r.record.warnings; }),
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
