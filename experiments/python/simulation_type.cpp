#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

/// A number of each body, or of each velocity: 0 at the root.
template <class Member>
Eigen::VectorXd of_bodies(const Model& model, Member member) {
  Eigen::VectorXd values(model.body_count());
  std::ranges::transform(model.bodies, values.begin(), member);
  return values;
}
template <class Member>
Eigen::VectorXd of_velocities(const Model& model, Member member) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(model.nv());
  std::ranges::transform(model.hinges, values.begin() + root_dofs, member);
  return values;
}

Eigen::MatrixX2d limits(const Model& model) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Eigen::MatrixX2d values(model.nv(), 2);
  values.topRows<root_dofs>().rowwise() = Eigen::RowVector2d(-infinity, infinity);
  values.bottomRows(model.nv() - root_dofs) = hinge_ranges(model).transpose();
  return values;
}

py::array_t<double> orientations(const PythonSimulation& run) {
  const auto& turns = run.sim.now.observation.kin.rotation;
  py::array_t<double> values(
      {static_cast<py::ssize_t>(turns.size()), py::ssize_t{3}, py::ssize_t{3}});
  for (std::size_t b = 0; b < turns.size(); ++b) {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.mutable_data(b, 0, 0)) =
        turns[b];
  }
  return values;
}

Eigen::MatrixXd mass_matrix(const PythonSimulation& run) {
  const Kinematics& kin = run.sim.now.observation.kin;
  return dense(run.model, kin,
               {body_inertias(run.model, kin), Eigen::VectorXd::Zero(run.model.nv())});
}

/// Row i is the generalised force of a unit force along axis i at the point.
Eigen::MatrixXd jacobian(const PythonSimulation& run, int body, const py::object& point) {
  if (body < 0 || body >= run.model.body_count()) {
    throw py::index_error(
        fmt::format("body = {}: must be from 0 to {}", body, run.model.body_count() - 1));
  }
  const Kinematics& kin = run.sim.now.observation.kin;
  const Eigen::Vector3d offset =
      kin.centre_offset(body) + kin.rotation[body] * numbers("point", point, 3);
  Eigen::MatrixXd rows(3, run.model.nv());
  for (int i = 0; i < 3; ++i) {
    Matrix6Xd wrench = Matrix6Xd::Zero(6, run.model.body_count());
    wrench.col(body) = wrench_of_force(Eigen::Vector3d::Unit(i), offset);
    rows.row(i) = generalised_force(run.model, kin, wrench);
  }
  return rows;
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
      .def(
          "set_state",
          [](Run& r, const py::object& q, const py::object& qdot) {
            r.set_state(numbers("q", q, r.model.nq()), numbers("qdot", qdot, r.model.nv()));
          },
          py::arg("q"), py::arg("qdot"),
          "Goes on from q (nq,) and qdot (nv,) at the same time, phase and knot. Ledgers begin "
          "anew. A run with a log raises ValueError: no program could make it again.")
      .def("close", &Run::close,
           "Ends the run, and its log, whose status is complete where the scene is over. It can be "
           "read and copied, but takes no more steps.")
      .def(
          "copy", &copy_of, py::arg("law") = py::none(), py::kw_only(), py::arg("set") = py::dict(),
          "A simulation that goes on from here independently, without a log; by `law` where given, "
          "and with other settings by `set`, as `hagfish branch` has them.")
      .def("mass_matrix", readable(&mass_matrix),
           "(nv, nv): of which qdot' M qdot / 2 is the kinetic energy; g, g cm and g cm2")
      .def(
          "jacobian",
          [](const Run& r, int body, const py::object& point) {
            r.require_readable();
            return jacobian(r, body, point);
          },
          py::arg("body"), py::arg("point") = py::make_tuple(0, 0, 0),
          "(3, nv): the velocity of a point of a body, cm/s, world, is this times qdot. `point`: "
          "(3,) from the body's centre in its own axes, cm")
      .def("__repr__",
           [](const Run& r) {
             return fmt::format("<hagfish.Simulation \"{}\": {}, t = {:g} s>",
                                r.resolved.scene.title, phase_name(r.sim.controller.phase),
                                r.time());
           })
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
      .def_property_readonly(
          "orientation", readable(&orientations),
          "(bodies, 3, 3) copy: their axes in columns, X to the tail; body to world")
      .def_property_readonly(
          "lengths", [](const Run& r) { return of_bodies(r.model, &Body::length); },
          "(bodies,) cm, along X of each body")
      .def_property_readonly(
          "radii", [](const Run& r) { return of_bodies(r.model, &Body::radius); },
          "(bodies,) radii of the skin, cm")
      .def_property_readonly(
          "limits", [](const Run& r) { return limits(r.model); },
          "(nv, 2) lowest and highest angle of each hinge, rad; infinite at the root. Where a "
          "joint's total bend has a limit: what this leaves a hinge if the other one is straight")
      .def_property_readonly(
          "stiffness", [](const Run& r) { return of_velocities(r.model, &Hinge::stiffness); },
          "(nv,) passive springs towards angle 0, dyn cm / rad; 0 at the root")
      .def_property_readonly(
          "damping", [](const Run& r) { return of_velocities(r.model, &Hinge::damping); },
          "(nv,) passive damping of the hinges, dyn cm s / rad; 0 at the root")
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
          [](Run& r, const py::object& memory) {
            r.require_readable();
            r.sim.controller.memory = numbers("memory", memory, -1);
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
