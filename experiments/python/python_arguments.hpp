// What Python's callers give, taken with a clear text for what is none of it.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "experiments/python/python_simulation.hpp"

namespace hagfish {

/// The run that Simulation(...) asks for. Throws TypeError, ValueError.
PythonRun python_run(const pybind11::object& scene, const pybind11::object& set,
                     const pybind11::object& qp, const pybind11::object& law,
                     const pybind11::object& log, bool force);

/// The numbers of `given`, an array or a sequence of `size` numbers, of any number where that is
/// -1; `name` stands for them in errors. Throws TypeError for what are no real numbers or may be
/// masked, and ValueError for another shape.
Eigen::VectorXd numbers(const char* name, const pybind11::object& given, Eigen::Index size);

/// Keys and values, a dict, as --set has them. Throws TypeError, and InputError for a value that is
/// neither a number, text nor a sequence of these.
std::vector<std::string> settings(const pybind11::object& set);

/// Throws TypeError where `law` is neither None nor callable.
void require_law(const pybind11::object& law);

/// "form, tighten, ... or free".
std::string phase_names();

/// Steps until what `until` of run() says: None, a time, the name of a phase or a callable, which
/// gets `self`. Throws TypeError, ValueError.
void run_until(PythonSimulation& run, const pybind11::object& self, const pybind11::object& until);

}  // namespace hagfish
