// Python's lock, let go while a simulation steps, and what becomes of threads when Python ends.
//
// Python ends a daemon thread that asks for the lock by unwinding it, which code that must not
// throw takes for a crash. Such a thread sleeps here instead until its process is gone. Python's
// exit waits for steps under way, whose storage it would take away.
#pragma once

#include <pybind11/pybind11.h>

namespace hagfish {

/// Lets go of the lock for its life.
class WithoutGil {
 public:
  WithoutGil();
  ~WithoutGil();
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* state_;
};

/// Takes the lock for its life, within that of a WithoutGil.
class WithGil {
 public:
  WithGil();
  ~WithGil();
  WithGil(const WithGil&) = delete;
  WithGil& operator=(const WithGil&) = delete;

 private:
  PyGILState_STATE state_;
};

/// Call this between steps, without the lock: does not return where Python ends.
void sleep_if_python_ends();

/// What `ask` returns, called with the lock within the life of a WithoutGil.
template <class Ask>
auto with_python(Ask&& ask) {
  const WithGil gil;
  return ask();
}

/// What a function of Python returns, called with the lock. Where Python ends meanwhile, its thread
/// sleeps. Throws error_already_set.
pybind11::object call(const pybind11::handle& function, const pybind11::tuple& arguments);

/// Makes Python's exit wait for steps under way. To be called once.
void wait_for_steps_at_exit();

}  // namespace hagfish
