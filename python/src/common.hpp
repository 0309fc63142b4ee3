#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "hypotrack/api/config_value.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/stop.hpp"

// What all parts of the module share: the rules of the GIL, and of exceptions.
//
// Python holds the GIL when it calls the module. The module gives it back before it calls
// hypotrack, whose threads may call Python (plugins, callbacks) and take it for that. So no thread
// waits for another one while it holds the GIL.

namespace hypotrack::python {

namespace py = pybind11;

/// Gives the GIL back while it lives. Once Python ends, threads but the main one never get it
/// again, and Python would unwind their stack, which C++ that catches everything cannot survive.
/// Such a thread stays here until the process ends.
class WithoutGil {
 public:
  WithoutGil() : state_(PyEval_SaveThread()) {}
  ~WithoutGil();
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

 private:
  PyThreadState* state_;
};

/// Takes the GIL while it lives, or stays as WithoutGil does.
class WithGil {
 public:
  WithGil();

 private:
  std::optional<py::gil_scoped_acquire> acquired_;
};

/// Calls C++ that may wait or work for long, without the GIL.
template <class Function>
decltype(auto) without_gil(Function&& function) {
  const WithoutGil release;
  return std::forward<Function>(function)();
}

/// Owns a Python object in C++. Any thread may destroy it.
class Held {
 public:
  explicit Held(py::object object) : object_(std::move(object)) {}
  Held(Held&&) = default;
  Held& operator=(Held&&) = delete;
  ~Held();

  /// Returns the object. The caller has the GIL.
  const py::object& get() const { return object_; }

 private:
  py::object object_;
};

/// Returns the type, the message and the traceback of a Python exception. The caller has the GIL.
std::string text_of(const py::error_already_set& error);

/// Throws the exception of a Python plugin as one of hypotrack: PluginError with its traceback;
/// Stopped for KeyboardInterrupt. The caller has the GIL.
[[noreturn]] void rethrow_from_python(py::error_already_set& error);

/// Calls Python code of a plugin in a thread of hypotrack: takes the GIL, and turns exceptions into
/// those of hypotrack.
template <class Function>
decltype(auto) in_python(Function&& function) {
  const WithGil acquire;
  try {
    return std::forward<Function>(function)();
  } catch (py::error_already_set& error) {
    rethrow_from_python(error);
  } catch (const py::cast_error& error) {
    throw PluginError(std::string("its Python code gave a value of another type: ") + error.what());
  }
}

/// A StopTest by which Ctrl-C ends work that the main thread of Python waits for.
class Interrupts {
 public:
  Interrupts() : thread_(std::this_thread::get_id()) {}

  /// Returns true once a signal handler of Python has thrown. Any thread may ask.
  bool operator()();
  /// Throws what the handler threw, if it did. The caller has the GIL.
  void rethrow() const {
    if (error_) throw py::error_already_set(*error_);
  }

 private:
  std::thread::id thread_;
  std::chrono::steady_clock::time_point next_ = {};
  std::atomic<bool> raised_ = false;
  std::optional<py::error_already_set> error_;
};

/// Refuses a second use of an object while one goes on, in another thread or from a callback.
class Busy {
 public:
  Busy(std::atomic<bool>& flag, const char* what) : flag_(flag) {
    if (flag_.exchange(true))
      throw Error(std::string("this ") + what +
                  " is at work already; use it from one thread at a time, and not from a callback "
                  "of its own");
  }
  ~Busy() { flag_ = false; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  std::atomic<bool>& flag_;
};

/// Destroys an object of hypotrack without the GIL: its threads may need it to end.
template <class T>
void end_without_gil(T& owner) {
  if (!owner) return;
  if (PyGILState_Check()) {
    const WithoutGil release;
    owner.reset();
  } else {
    owner.reset();
  }
}

/// Returns the value of nested dicts, lists, tuples, texts, numbers, bools, paths, numpy arrays and
/// None. Throws ConfigError, naming the document and the key path, on anything else.
ConfigValue value_of(const py::handle& object, const std::string& document);

/// Returns a value as YAML in one line, for overrides.
std::string line_of(const ConfigNode& node);

// The parts of the module, each in a file of its name.
void add_errors(py::module_& module);
void add_scene(py::module_& module);
void add_cameras(py::module_& module);
void add_frames(py::module_& module);
void add_solution(py::module_& module);
void add_frame_cost(py::module_& module);
void add_tracker(py::module_& module);
void add_source(py::module_& module);
void add_session(py::module_& module);
void add_renderer(py::module_& module);
void add_metrics(py::module_& module);
void add_search(py::module_& module);
void add_objective(py::module_& module);
void add_judge(py::module_& module);
void add_plugins(py::module_& module);

}  // namespace hypotrack::python
