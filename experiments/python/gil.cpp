#include "experiments/python/gil.hpp"

#include <cxxabi.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace hagfish {
namespace {

// Of the process, as Python is.
std::atomic<int> stepping = 0;  // threads within WithoutGil and not within WithGil
std::atomic<bool> ending = false;
std::thread::id ender;  // set before `ending`

[[noreturn]] void sleep_for_ever() {
  for (;;) ::pause();
}

void end_stepping() {
  --stepping;
  if (ending && std::this_thread::get_id() != ender) sleep_for_ever();
}

/// Takes the lock by `take`.
template <class Take>
auto locked(Take&& take) {
  end_stepping();
  try {
    return take();
  } catch (abi::__forced_unwind&) {
    sleep_for_ever();
  }
}

void wait_for_steps() {
  ender = std::this_thread::get_id();
  ending = true;
  const pybind11::gil_scoped_release others;
  while (stepping > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace

void sleep_if_python_ends() {
  if (!ending || std::this_thread::get_id() == ender) return;
  end_stepping();
}

WithoutGil::WithoutGil() {
  ++stepping;  // before the lock is let go of, so that Python's end sees it
  state_ = PyEval_SaveThread();
  sleep_if_python_ends();
}

WithoutGil::~WithoutGil() {
  locked([this] { PyEval_RestoreThread(state_); });
}

WithGil::WithGil() : state_(locked([] { return PyGILState_Ensure(); })) {}

WithGil::~WithGil() {
  ++stepping;
  PyGILState_Release(state_);
  sleep_if_python_ends();
}

pybind11::object call(const pybind11::handle& function, const pybind11::tuple& arguments) {
  PyObject* returned = nullptr;
  try {
    returned = PyObject_Call(function.ptr(), arguments.ptr(), nullptr);
  } catch (abi::__forced_unwind&) {
    sleep_for_ever();  // before any reference is given back without the lock
  }
  if (returned == nullptr) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::object>(returned);
}

void wait_for_steps_at_exit() {
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function(&wait_for_steps));
  // Threads of the parent are not there in a forked child.
  ::pthread_atfork(nullptr, nullptr, [] { stepping = 0; });
}

}  // namespace hagfish
