// The compiled part of `import hagfish`.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>

#include "core/control/laws.hpp"
#include "core/input/builtin_files.hpp"
#include "core/input/input_error.hpp"
#include "core/log/build_info.hpp"
#include "core/log/hdf5/hdf5_error.hpp"
#include "core/step/outcome.hpp"
#include "experiments/python/gil.hpp"
#include "experiments/python/python_control.hpp"
#include "experiments/python/python_simulation.hpp"

namespace py = pybind11;

namespace hagfish {
namespace {

/// Throws ImportError where NumPy is not one whose structures this pybind11 knows.
void require_known_numpy() {
  constexpr int first_for_both = 0x020c0000;  // pybind11 2.12: NumPy 1 and 2
  const std::string version = py::str(py::module_::import("numpy").attr("__version__"));
  if (PYBIND11_VERSION_HEX >= first_for_both || version.starts_with("1.")) return;
  throw py::import_error("hagfish was built for NumPy 1, but this is NumPy " + version +
                         ": use another NumPy, or build with pybind11 2.12 or newer");
}

}  // namespace
}  // namespace hagfish

PYBIND11_MODULE(_core, module) {
  using namespace hagfish;
  require_known_numpy();
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<FileError>(module, "FileError", PyExc_OSError);
  // Kept for the life of the interpreter, as pybind11 keeps its own exceptions.
  static const py::handle step_error =
      py::exception<StepError>(module, "StepError", PyExc_RuntimeError).release();
  // NOLINTNEXTLINE(performance-unnecessary-value-param): pybind11 gives it so
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const StepError& error) {
      py::object raised = step_error(error.what());
      raised.attr("outcome") = outcome_name(error.outcome());
      PyErr_SetObject(step_error.ptr(), raised.ptr());
    }
  });
  wait_for_steps_at_exit();
  declare_controls(module);
  declare_simulation(module);
  module.def("scenes", &builtin_scene_names, "Names of the built-in scenes.");
  py::dict known;
  for (const Law* law : laws()) known[py::str(law->name)] = law->description;
  module.attr("laws") = known;
  module.attr("revision") = build_revision();
  module.attr("__version__") = build_version();
}
