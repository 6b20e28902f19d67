// A run as Python sees it.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/input/files/scene_reader.hpp"
#include "core/log/log_writer.hpp"
#include "core/run/simulation.hpp"
#include "core/run/slide.hpp"
#include "experiments/python/python_control.hpp"

namespace hagfish {

/// How a run is begun: as `hagfish run` takes it.
struct PythonRun {
  std::string scene;             ///< a built-in scene's name or a file
  std::vector<std::string> set;  ///< KEY=VALUE overrides
  std::string qp;                ///< QP back end
  pybind11::object law;          ///< callable(simulation, control), or None
  std::string log;               ///< log to write; empty: none
  bool force = false;            ///< replaces a log that is there
  std::string command;           ///< command that the log has
};

class PythonSimulation {
 public:
  /// Throws InputError, FileError, std::invalid_argument.
  explicit PythonSimulation(const PythonRun& run);
  /// Goes on independently, without a log; by `law` where that is not None, and with KEY=VALUE
  /// overrides `set`. Throws InputError, and std::invalid_argument as change_scene.
  PythonSimulation(const PythonSimulation& other, const pybind11::object& law,
                   const std::vector<std::string>& set);
  PythonSimulation(const PythonSimulation&) = delete;
  PythonSimulation& operator=(const PythonSimulation&) = delete;

  /// Throws std::runtime_error where another thread has it at work.
  void require_readable() const;
  /// Throws std::runtime_error where it is at work, in this thread or another.
  void require_idle() const;

  /// A step by the run's law. Throws StepError, FileError and what the law throws.
  void step();
  /// A step as `asked` says, which a log must expect: the scene's law is then "own".
  void step_by(PythonControl& asked);
  /// Steps while `wanted`, asked without the GIL, says so and the scene is not over; a signal to
  /// Python ends them with what it raises.
  void run_while(const std::function<bool()>& wanted);
  /// Goes on from coordinates `to` (nq) and velocities `rate` (nv) at the same time, with ledgers
  /// and solver as at a start. Throws std::invalid_argument for a number that is not finite, for a
  /// quaternion of zeros, and in a run with a log, which could not be made again.
  void set_state(const Eigen::VectorXd& to, const Eigen::VectorXd& rate);
  /// Ends the run, and its log: "complete" where the scene is over.
  void close();
  bool over() const { return finished(sim, resolved.scene); }
  /// Its law, which may hold the simulation itself.
  pybind11::object& law() { return law_; }
  double time() const { return time_of(sim, resolved.scene); }

  ResolvedScene resolved;
  const Model& model = resolved.model;
  Simulation sim;
  StepRecord record;
  // What `sim` has, which there moves about: storage of views.
  Eigen::VectorXd q, qdot;
  Eigen::Matrix3Xd position, velocity;
  PythonControl control;  ///< control of the record
  SlideWatch slides;      ///< slides through the states after its steps

 private:
  class Work;
  void hold_views();
  void take_law();
  void take();
  void show();
  void ask_python();
  void take_commands(PythonControl& asked) const;

  Scene scene_;  ///< the resolved one, but for a law that a step brings
  pybind11::object law_;
  std::string qp_;
  std::optional<LogWriter> log_;
  bool closed_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::string failure_;     ///< failure of the last step
  std::string raised_;      ///< what Python raised in it, in a line
  std::thread::id worker_;  ///< thread that has it at work
};

/// Declares Simulation in `module` (simulation_type.cpp).
void declare_simulation(pybind11::module_& module);

}  // namespace hagfish

template <>
class pybind11::detail::type_caster<hagfish::PythonSimulation>
    : public hagfish::BegunCaster<hagfish::PythonSimulation> {};
