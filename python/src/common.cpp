#include "common.hpp"

#include <cxxabi.h>
#include <unistd.h>

namespace hypotrack::python {

namespace {

/// Returns whether Python ends: threads but the main one do not get the GIL any more.
bool is_ending() {
#if PY_VERSION_HEX >= 0x030D0000
  return Py_IsFinalizing() != 0;
#else
  return _Py_IsFinalizing() != 0;
#endif
}

[[noreturn]] void stay() {
  for (;;) pause();
}

}  // namespace

WithoutGil::~WithoutGil() {
  try {
    PyEval_RestoreThread(state_);
  } catch (const abi::__forced_unwind&) {
    stay();
  }
}

WithGil::WithGil() {
  try {
    acquired_.emplace();
  } catch (const abi::__forced_unwind&) {
    stay();
  }
}

Held::~Held() {
  if (!object_) return;
  if (!Py_IsInitialized() || (is_ending() && !PyGILState_Check())) {
    object_.release();
    return;
  }
  const WithGil acquire;
  object_ = py::object();
}

std::string text_of(const py::error_already_set& error) {
  try {
    const py::object none = py::none();
    const py::object lines = py::module_::import("traceback")
                                 .attr("format_exception")(error.type(), error.value(),
                                                           error.trace() ? error.trace() : none);
    std::string text = py::cast<py::bytes>(
        py::str("").attr("join")(lines).attr("encode")("utf-8", "backslashreplace"));
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
  } catch (const py::error_already_set&) {
    return error.what();
  }
}

void rethrow_from_python(py::error_already_set& error) {
  if (error.matches(PyExc_KeyboardInterrupt)) throw Stopped();
  const std::string type = py::cast<std::string>(error.type().attr("__name__"));
  throw PluginError("its Python code raised " + type + ":\n" + text_of(error));
}

bool Interrupts::operator()() {
  if (raised_) return true;
  if (std::this_thread::get_id() != thread_) return false;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return false;
  next_ = now + std::chrono::milliseconds(50);
  const WithGil acquire;
  if (PyErr_CheckSignals() == 0) return false;
  error_.emplace();  // takes what was thrown
  raised_ = true;
  return true;
}

namespace {

/// Adds the exception of a type. Its message may name files whose names are not UTF-8.
template <class E>
py::handle add_error(py::module_& module, const char* name, const char* doc, py::handle base) {
  static const auto* const kType = new py::exception<E>(module, name, base);  // outlives Python
  kType->attr("__doc__") = doc;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const E& error) {
      const std::string_view what = error.what();
      const auto text = py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(
          what.data(), static_cast<py::ssize_t>(what.size()), "surrogateescape"));
      if (text) PyErr_SetObject(kType->ptr(), text.ptr());
    }
  });
  return *kType;
}

}  // namespace

void add_errors(py::module_& module) {
  const py::handle error = add_error<Error>(
      module, "Error", "Base of all exceptions of hypotrack. The message is complete.",
      PyExc_Exception);
  add_error<ConfigError>(module, "ConfigError", "An invalid scene or parameter.", error);
  add_error<DataError>(module, "DataError", "An unusable picture, mesh, calibration or table.",
                       error);
  add_error<PluginError>(module, "PluginError",
                         "A plugin that is missing or breaks its contract, or that raised.", error);
  add_error<DeviceError>(module, "DeviceError", "A missing or failed GPU or OpenGL context.",
                         error);
  add_error<OutputError>(module, "OutputError", "A result that cannot be written.", error);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Stopped&) {
      PyErr_SetNone(PyExc_KeyboardInterrupt);
    }
  });
}

}  // namespace hypotrack::python
