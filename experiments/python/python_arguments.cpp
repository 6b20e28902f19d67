#include "experiments/python/python_arguments.hpp"

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/input/input_error.hpp"
#include "core/input/input_text.hpp"
#include "core/scene/phase.hpp"
#include "experiments/python/gil.hpp"

namespace py = pybind11;

namespace hagfish {
namespace {

[[noreturn]] void refuse(const char* name, const py::handle& given, const std::string& wanted) {
  throw py::type_error(fmt::format("{} = {}: {}", name, std::string(py::repr(given)), wanted));
}

std::string path_of(const char* name, const py::object& given, const char* wanted) {
  const py::module_ os = py::module_::import("os");
  const bool is_path = py::isinstance<py::str>(given) || py::isinstance<py::bytes>(given) ||
                       py::isinstance(given, os.attr("PathLike"));
  if (!is_path) refuse(name, given, wanted);
  auto path = os.attr("fsencode")(given).cast<std::string>();
  if (path.empty()) throw py::value_error(fmt::format("{} = '': {}", name, wanted));
  if (path.find('\0') != std::string::npos) {
    throw py::value_error(fmt::format("{} has a byte 0: {}", name, wanted));
  }
  return path;
}

/// Throws TypeError for a masked array: what it masks would be taken for numbers.
void refuse_masked(const std::string& name, const py::handle& given) {
  if (!py::isinstance(given, py::module_::import("numpy").attr("ma").attr("MaskedArray"))) return;
  throw py::type_error(name + " is a masked array: give one without a mask, as by filled()");
}

/// The value of `key` as --set has it: numbers so that the same doubles are read, and text as it
/// is, but quoted `within` an array.
std::string setting_text(const std::string& key, py::object value, bool within) {
  const auto of = [](const char* module, const char* name) -> py::object {
    return py::module_::import(module).attr(name);
  };
  refuse_masked("set: " + key, value);
  if (py::isinstance<py::array>(value)) value = value[py::tuple()];  // a scalar has no items
  if (py::isinstance(value, of("os", "PathLike"))) value = of("os", "fspath")(value);
  if (py::isinstance<py::str>(value)) {
    return py::str(within ? of("json", "dumps")(value, py::arg("ensure_ascii") = false) : value);
  }
  if (py::isinstance(value, py::make_tuple(of("numbers", "Real"), of("numpy", "bool_")))) {
    const std::string text = py::str(value);
    return text == "True" ? "true" : text == "False" ? "false" : text;
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value) ||
      py::isinstance<py::array>(value)) {
    std::vector<std::string> items;
    for (const py::handle item : value) {
      items.push_back(setting_text(key, py::reinterpret_borrow<py::object>(item), true));
    }
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  throw InputError(
      fmt::format("set: {} = {}: must be a number, true or false, text, or a list, "
                  "tuple or array of these",
                  key, shortened(printable(std::string(py::repr(value))))));
}

double time_of(const py::object& until) {
  const char* wanted = "a time (s), the name of a phase, or what is called with the simulation";
  if (py::isinstance<py::bool_>(until)) refuse("until", until, wanted);
  const double time = PyFloat_AsDouble(until.ptr());
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();
    refuse("until", until, wanted);
  }
  if (std::isnan(time)) throw py::value_error("until = nan: must be a number");
  return time;
}

/// To the first step at or past `end` (s). A time of a step is a product, so one that falls short
/// by rounding is there; where the run begins with such a one it takes another step, so that
/// whoever runs until the time is no less comes to an end.
void run_until_time(PythonSimulation& run, double end) {
  constexpr double rounding = 1e-6;  // of a step
  const double close = end - rounding * run.resolved.scene.time.step;
  run.run_while([&run, end, close, begun = false]() mutable {
    return run.time() < (std::exchange(begun, true) ? close : end);
  });
}

Phase phase_called(const std::string& name) {
  const auto* const found = std::ranges::find(phase_table, name, &PhaseEntry::name);
  if (found == phase_table.end()) {
    throw py::value_error(fmt::format("until = {}: {}", name, phase_names()));
  }
  return found->value;
}

}  // namespace

std::string phase_names() {
  std::string words;
  for (const PhaseEntry& entry : phase_table) {
    words += words.empty() ? "" : (&entry == &phase_table.back() ? " or " : ", ");
    words += entry.name;
  }
  return words;
}

PythonRun python_run(const py::object& scene, const py::object& set, const py::object& qp,
                     const py::object& law, const py::object& log, bool force) {
  require_law(law);
  if (!py::isinstance<py::str>(qp)) refuse("qp", qp, "the name of a QP back end");
  PythonRun run{path_of("scene", scene, "a built-in scene's name or a file"),
                settings(set),
                qp.cast<std::string>(),
                law,
                log.is_none() ? "" : path_of("log", log, "a file to write"),
                force,
                ""};
  run.command =
      fmt::format("hagfish.Simulation({}, set={}{})", std::string(py::repr(py::str(run.scene))),
                  std::string(py::repr(set)), law.is_none() ? "" : ", law=...");
  return run;
}

Eigen::VectorXd numbers(const char* name, const py::object& given, Eigen::Index size) {
  refuse_masked(name, given);
  const py::array array = py::module_::import("numpy").attr("asarray")(given);
  if (std::string_view("biuf").find(array.dtype().kind()) == std::string_view::npos) {
    throw py::type_error(fmt::format("{} must be real numbers, not {} of dtype {}", name,
                                     Py_TYPE(given.ptr())->tp_name,
                                     std::string(py::str(array.dtype()))));
  }
  if (array.ndim() != 1 || (size >= 0 && array.size() != size)) {
    throw py::value_error(fmt::format("{} has shape {}, but shape ({},) is wanted", name,
                                      std::string(py::str(array.attr("shape"))),
                                      size < 0 ? "n" : std::to_string(size)));
  }
  const py::array_t<double, py::array::c_style | py::array::forcecast> doubles(array);
  return Eigen::VectorXd::Map(doubles.data(), doubles.size());
}

std::vector<std::string> settings(const py::object& set) {
  if (!py::isinstance<py::dict>(set)) refuse("set", set, "a dict of keys and values");
  std::vector<std::string> list;
  for (const auto& [key, value] : set.cast<py::dict>()) {
    const std::string name = py::str(key);
    list.push_back(name + "=" +
                   setting_text(name, py::reinterpret_borrow<py::object>(value), false));
  }
  return list;
}

void require_law(const py::object& law) {
  if (!law.is_none() && PyCallable_Check(law.ptr()) == 0) {
    refuse("law", law, "what is called with a simulation and its control");
  }
}

void run_until(PythonSimulation& run, const py::object& self, const py::object& until) {
  if (until.is_none()) {
    run.run_while([] { return true; });
  } else if (py::isinstance<py::str>(until)) {
    run.run_while([&run, order = phase_order(phase_called(until.cast<std::string>()))] {
      return phase_order(run.sim.controller.phase) <= order;
    });
  } else if (PyCallable_Check(until.ptr()) != 0) {
    run.run_while([&] {
      return with_python([&] {
        const int reached = PyObject_IsTrue(call(until, py::make_tuple(self)).ptr());
        if (reached < 0) throw py::error_already_set();
        return reached == 0;
      });
    });
  } else {
    run_until_time(run, time_of(until));
  }
}

}  // namespace hagfish
