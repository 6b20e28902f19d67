#include "experiments/python/python_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/input/input_text.hpp"
#include "experiments/common/idle_settings.hpp"
#include "experiments/common/run_header.hpp"
#include "experiments/common/scene_argument.hpp"
#include "experiments/python/gil.hpp"

namespace py = pybind11;

namespace hagfish {
namespace {

/// Steps from one look at Python's signals to the next.
constexpr int signal_stride = 64;

ResolvedScene resolve(const PythonRun& run) {
  std::vector<std::string> set = run.set;
  if (!run.law.is_none()) set.emplace_back("controller.law=own");
  ResolvedScene resolved = scene_argument(run.scene, set);
  require_settings_act(resolved.scene, run.set);
  return resolved;
}

/// `resolved` with other settings.
ResolvedScene changed(const ResolvedScene& resolved, const std::vector<std::string>& set) {
  if (set.empty()) return resolved;
  return read_scene_text(scene_to_toml(resolved.scene, resolved.specimen), "copy", set);
}

/// What Python raised, in a line: without the traceback, which its caller sees.
std::string line_of(const py::error_already_set& error) {
  std::string text = Py_TYPE(error.value().ptr())->tp_name;
  const auto words = py::reinterpret_steal<py::object>(PyObject_Str(error.value().ptr()));
  if (!words) {
    PyErr_Clear();
    return text;
  }
  text += ": " + words.attr("encode")("utf-8", "replace").cast<std::string>();
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return printable(text);
}

}  // namespace

/// Marks a simulation as at work in this thread. Made and destroyed with Python's lock, by which
/// other threads see it.
class PythonSimulation::Work {
 public:
  explicit Work(PythonSimulation& of) : of_(of) {
    of.require_idle();
    of.worker_ = std::this_thread::get_id();
  }
  ~Work() { of_.worker_ = {}; }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

 private:
  PythonSimulation& of_;
};

void PythonSimulation::require_readable() const {
  if (worker_ == std::thread::id() || worker_ == std::this_thread::get_id()) return;
  throw std::runtime_error(
      "another thread is using the simulation; only one thread can use it at a time");
}

void PythonSimulation::require_idle() const {
  require_readable();
  if (worker_ == std::thread::id()) return;
  throw std::runtime_error(
      "a function that the simulation calls cannot step it; step a copy of it");
}

PythonSimulation::PythonSimulation(const PythonRun& run)
    : resolved(resolve(run)),
      sim(start(model, resolved.scene, run.qp)),
      control(record.control, model.nv()),
      slides(model),
      scene_(resolved.scene),
      law_(run.law),
      qp_(run.qp) {
  hold_views();
  if (!run.log.empty()) {
    log_.emplace(run.log, run.force, log_header(resolved, run.qp, run.command), model,
                 resolved.scene);
  }
}

PythonSimulation::PythonSimulation(const PythonSimulation& other, const py::object& law,
                                   const std::vector<std::string>& set)
    : resolved(changed(other.resolved, set)),
      sim(other.sim),
      control(record.control, model.nv()),
      slides(other.slides),
      scene_(resolved.scene),
      law_(law.is_none() ? other.law_ : law),
      qp_(other.qp_) {
  if (!set.empty()) change_scene(model, other.resolved.scene, resolved.scene, sim);
  if (!law.is_none()) resolved.scene.controller.law = own_law;
  require_settings_act_from(sim, resolved.scene, set);
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
  with_python([this] {
    control.begin();
    const py::object self = py::cast(this);
    try {
      call(law_, py::make_tuple(
                     self, py::cast(&control, py::return_value_policy::reference_internal, self)));
      take_commands(control);
    } catch (const py::error_already_set& error) {
      raised_ = line_of(error);
      throw;
    }
  });
}

/// Puts Python's commands into a control of this animal.
void PythonSimulation::take_commands(PythonControl& asked) const {
  if (asked.nv != model.nv()) {
    throw std::invalid_argument(
        fmt::format("the control has {} velocities, but the animal has {}", asked.nv, model.nv()));
  }
  asked.end();
  for (const ThigmotaxisCommand& command : asked.control->thigmotaxis) {
    const Contact& at = command.contact;
    if (std::max(at.body_a(), at.body_b()) >= model.body_count()) {
      throw std::invalid_argument("a command has a contact of another animal");
    }
  }
}

void PythonSimulation::take() {
  if (closed_) throw std::invalid_argument("the simulation is closed; step a copy of it");
  const auto fail = [this](const std::string& why) {
    failure_ = fmt::format("{} at step {} (t = {:.4f} s, {})", why, sim.step, time(),
                           phase_name(record.controller.phase));
  };
  try {
    take_step(model, scene_, sim, record);
  } catch (const py::error_already_set&) {
    fail(raised_);
    throw;
  } catch (const std::exception& error) {
    fail(error.what());
    throw;
  }
  failure_.clear();
  if (log_) {
    const auto elapsed = std::chrono::steady_clock::now() - begin_;
    log_->write(record, sim, std::chrono::duration<double>(elapsed).count());
  }
  slides.see(record.controller.phase, knot_span(record.controller), record.after.state.q);
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
  const Work work(*this);
  take_law();
  const WithoutGil no_gil;
  take();
}

void PythonSimulation::step_by(PythonControl& asked) {
  if (log_ && resolved.scene.controller.law != own_law) {
    throw std::invalid_argument(
        "a step was given a control, but controller.law is not \"own\": begin the run with "
        R"(set={"controller.law": "own"})");
  }
  const Work work(*this);
  take_commands(asked);
  scene_.controller.law = own_law;
  sim.law = [given = *asked.control](const Situation&, Eigen::VectorXd&, Control& of_step) {
    of_step = given;
  };
  const WithoutGil no_gil;
  take();
}

void PythonSimulation::run_while(const std::function<bool()>& wanted) {
  const Work work(*this);
  take_law();
  const WithoutGil no_gil;
  for (int n = 1; !over() && wanted(); ++n) {
    take();
    sleep_if_python_ends();
    if (n % signal_stride == 0) {
      with_python([] {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      });
    }
  }
}

void PythonSimulation::set_state(const Eigen::VectorXd& to, const Eigen::VectorXd& rate) {
  require_idle();
  if (log_) throw std::invalid_argument("a run with a log cannot be put elsewhere; copy it");
  if (!to.allFinite() || !rate.allFinite()) {
    throw std::invalid_argument("set_state: q or qdot has a number that is not finite");
  }
  if (to.segment<4>(3).isZero(0)) {
    throw std::invalid_argument("set_state: q[3:7] is a quaternion and must not be 0");
  }
  State state{to, rate};
  state.q.segment<4>(3).normalize();
  sim = start_from(model, scene_, qp_, std::move(state), sim.controller, sim.step);
  slides = SlideWatch(model);
  show();
}

void PythonSimulation::close() {
  require_idle();
  closed_ = true;
  if (!log_) return;
  const std::string status = over()             ? "complete"
                             : failure_.empty() ? fmt::format("failed: closed at step {}", sim.step)
                                                : "failed: " + failure_;
  log_->finish(status, sim);
  log_.reset();
}

}  // namespace hagfish
