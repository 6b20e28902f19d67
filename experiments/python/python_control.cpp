#include "experiments/python/python_control.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <string>

#include "experiments/python/python_arguments.hpp"

namespace py = pybind11;

namespace hagfish {
namespace {

const char* name_of(KnotEnd end) {
  constexpr const char* names[] = {"first", "last", "neither"};
  return names[static_cast<std::size_t>(end)];
}

KnotEnd end_called(const std::string& name) {
  for (const KnotEnd end : {KnotEnd::first, KnotEnd::last, KnotEnd::neither}) {
    if (name == name_of(end)) return end;
  }
  throw py::value_error("end = " + name + R"(: "first", "last" or "neither")");
}

const char* name_of(BodyEnd end) { return end == BodyEnd::head ? "head" : "tail"; }

BodyEnd body_end_called(const std::string& name) {
  if (name != "head" && name != "tail") {
    throw py::value_error("towards = " + name + R"(: "head" or "tail")");
  }
  return name == "head" ? BodyEnd::head : BodyEnd::tail;
}

const char* name_of(Eq6Slip slip) { return slip == Eq6Slip::paper ? "paper" : "shape"; }

Eq6Slip slip_called(const std::string& name) {
  if (name != "paper" && name != "shape") {
    throw py::value_error("slip = " + name + R"(: "paper" or "shape")");
  }
  return name == "paper" ? Eq6Slip::paper : Eq6Slip::shape;
}

/// The torques asked for, 0 where there were none. Views hold on to the storage, so what is
/// assigned must leave it where it is: to head(nv).
ActiveTorque& whole(PythonControl& self) {
  ActiveTorque& torque = self.control->torque;
  if (torque.value.size() == 0) torque.value.setZero(self.nv);
  if (torque.rate.size() == 0) torque.rate.setZero(self.nv);
  return torque;
}

py::array_t<double> torque_view(const py::object& self, Eigen::VectorXd ActiveTorque::*member) {
  Eigen::VectorXd& values = whole(self.cast<PythonControl&>()).*member;
  return view(self, values.data(), {values.size()}, true);
}

}  // namespace

py::array_t<double> view(py::handle owner, double* data, const std::vector<py::ssize_t>& shape,
                         bool writable) {
  py::array_t<double> array(shape, data, owner);
  if (!writable) array.attr("setflags")(py::arg("write") = false);
  return array;
}

void PythonControl::begin() {
  commands = py::list();
  for (const ThigmotaxisCommand& command : control->thigmotaxis) commands.append(command);
}

void PythonControl::end() {
  control->thigmotaxis.clear();
  for (const py::handle command : commands) {
    if (!py::isinstance<ThigmotaxisCommand>(command)) {
      throw py::type_error("control.commands has " + std::string(py::repr(command)) +
                           ", but each must be a Command");
    }
    control->thigmotaxis.push_back(command.cast<const ThigmotaxisCommand&>());
  }
}

void declare_controls(py::module_& module) {
  py::class_<Contact>(module, "Contact", R"(Where two strands of the body touch or nearly touch.)")
      .def_property_readonly(
          "spline_a", [](const Contact& c) { return c.segment_a + c.t_a; },
          "place on the strand nearer the head, in bodies from the head")
      .def_property_readonly(
          "spline_b", [](const Contact& c) { return c.segment_b + c.t_b; },
          "place on the strand nearer the tail, in bodies from the head")
      .def_readonly("arc_a", &Contact::arc_a, "arc length from the head, cm")
      .def_readonly("arc_b", &Contact::arc_b, "arc length from the head, cm")
      .def_readonly("gap", &Contact::gap, "cm; negative where the skins overlap")
      .def_property_readonly("body_a", &Contact::body_a, "index of the nearest body")
      .def_property_readonly("body_b", &Contact::body_b, "index of the nearest body")
      .def_readonly("normal", &Contact::normal, "(3,) unit, world, from b to a")
      .def_readonly("tangent_a", &Contact::tangent_a, "(3,) unit, world, to the tail")
      .def_readonly("tangent_b", &Contact::tangent_b, "(3,) unit, world, to the tail");

  py::class_<ThigmotaxisCommand>(module, "Command",
                                 R"(Commanded sliding at one contact: two rows of Eq. 6.)")
      .def(
          py::init([](const Contact& contact, double a, double b, const std::string& towards,
                      double effort, const std::string& end, const std::string& slip) {
            return ThigmotaxisCommand{contact, {a, b},          body_end_called(towards),
                                      effort,  end_called(end), slip_called(slip)};
          }),
          py::arg("contact"), py::arg("a"), py::arg("b"), py::kw_only(),
          py::arg("towards") = "head", py::arg("effort") = 1.0, py::arg("end") = "neither",
          py::arg("slip") = "paper",
          R"(`a`, `b`: speeds along the tangents of the two strands, cm/s. `towards`: "head", or "tail", which turns
both tangents. `effort`: share of controller.cap that bounds the rows' forces. `end`: "first" or "last" where
the contact is that one of the knot. `slip`: "paper" asks the rows for these speeds, as in Eq. 6, "shape" for the
slip of strands that run along themselves at them (controller.eq6_slip).)")
      .def_readwrite("contact", &ThigmotaxisCommand::contact)
      .def_property(
          "a", [](const ThigmotaxisCommand& c) { return c.speed.a; },
          [](ThigmotaxisCommand& c, double speed) { c.speed.a = speed; }, "cm/s")
      .def_property(
          "b", [](const ThigmotaxisCommand& c) { return c.speed.b; },
          [](ThigmotaxisCommand& c, double speed) { c.speed.b = speed; }, "cm/s")
      .def_readwrite("effort", &ThigmotaxisCommand::effort, "share of controller.cap")
      .def_property(
          "towards", [](const ThigmotaxisCommand& c) { return name_of(c.towards); },
          [](ThigmotaxisCommand& c, const std::string& name) { c.towards = body_end_called(name); })
      .def_property(
          "end", [](const ThigmotaxisCommand& c) { return name_of(c.end); },
          [](ThigmotaxisCommand& c, const std::string& name) { c.end = end_called(name); })
      .def_property(
          "slip", [](const ThigmotaxisCommand& c) { return name_of(c.slip); },
          [](ThigmotaxisCommand& c, const std::string& name) { c.slip = slip_called(name); },
          "\"paper\": a and b are asked of the rows; \"shape\": of the strands "
          "(controller.eq6_slip)");

  py::class_<PythonControl>(module, "Control", R"(What the animal does in a step.)")
      .def_property(
          "clamp_head", [](const PythonControl& c) { return c.control->clamp_head; },
          [](PythonControl& c, bool clamp) { c.control->clamp_head = clamp; },
          "whether the head is held")
      .def_property(
          "tip",
          [](const py::object& self) {
            return view(self, self.cast<PythonControl&>().control->tip.value.data(), {3}, true);
          },
          [](PythonControl& c, const py::object& force) {
            c.control->tip.value = numbers("tip", force, 3);
          },
          "(3,) force on the last body's centre, dyn, world")
      .def_property(
          "tip_rate", [](const PythonControl& c) { return c.control->tip.rate; },
          [](PythonControl& c, double rate) { c.control->tip.rate = rate; },
          "what that force loses by the body's velocity, dyn s/cm")
      .def_readwrite("commands", &PythonControl::commands,
                     "list of Command: rows of Eq. 6 at any number of contacts")
      .def_property(
          "torque", [](const py::object& self) { return torque_view(self, &ActiveTorque::value); },
          [](PythonControl& c, const py::object& v) {
            whole(c).value.head(c.nv) = numbers("torque", v, c.nv);
          },
          "(nv,) view: torques at the hinges, 0 at the root's six velocities, dyn cm")
      .def_property(
          "torque_rate",
          [](const py::object& self) { return torque_view(self, &ActiveTorque::rate); },
          [](PythonControl& c, const py::object& v) {
            whole(c).rate.head(c.nv) = numbers("torque_rate", v, c.nv);
          },
          "(nv,) view: what they lose by the hinges' rates, not negative, dyn cm s")
      .def_property(
          "rest_shape",
          [](const PythonControl& c) -> std::optional<Eigen::VectorXd> {
            if (c.control->rest_shape.size() == 0) return std::nullopt;
            return c.control->rest_shape;
          },
          [](PythonControl& c, const py::object& v) {
            c.control->rest_shape =
                v.is_none() ? Eigen::VectorXd() : numbers("rest_shape", v, c.nv);
          },
          "(nv,) copy: angles that muscles pull the hinges to by the scene's [active], rad; None: "
          "they do not")
      .def(
          "clear",
          [](PythonControl& c) {
            c.control->tip = {};
            c.commands = py::list();
            c.control->rest_shape.resize(0);
            whole(c).value.setZero();
            whole(c).rate.setZero();
          },
          "Asks for nothing but the clamp.");
}

}  // namespace hagfish
