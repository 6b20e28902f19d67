// Controls as Python sees them.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <vector>

#include "core/step/step_input.hpp"
#include "experiments/python/begun.hpp"

namespace hagfish {

/// A control of an animal of `nv` velocities: one of its own, or that of a simulation at work.
struct PythonControl {
  explicit PythonControl(Eigen::Index nv_of_it)
      : owned(std::make_unique<Control>()), control(owned.get()), nv(nv_of_it) {}
  PythonControl(Control& of, Eigen::Index nv_of_it) : control(&of), nv(nv_of_it) {}

  /// Python's commands are objects of its own: taken from the control, and put there again.
  void begin();
  void end();

  std::unique_ptr<Control> owned;
  Control* control;
  Eigen::Index nv;
  pybind11::list commands;
};

/// Declares Contact, Command and Control in `module`.
void declare_controls(pybind11::module_& module);

/// A numpy array of float64 on `data`, which `owner` keeps alive; no copy.
pybind11::array_t<double> view(pybind11::handle owner, double* data,
                               const std::vector<pybind11::ssize_t>& shape, bool writable);

}  // namespace hagfish

template <>
class pybind11::detail::type_caster<hagfish::Contact>
    : public hagfish::BegunCaster<hagfish::Contact> {};

template <>
class pybind11::detail::type_caster<hagfish::ThigmotaxisCommand>
    : public hagfish::BegunCaster<hagfish::ThigmotaxisCommand> {};

template <>
class pybind11::detail::type_caster<hagfish::PythonControl>
    : public hagfish::BegunCaster<hagfish::PythonControl> {};
