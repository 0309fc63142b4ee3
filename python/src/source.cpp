#include "source.hpp"

#include <pybind11/stl.h>

#include <climits>
#include <optional>

#include "arrays.hpp"
#include "hypotrack/plugin/source.hpp"
#include "plugins.hpp"

namespace hypotrack::python {
namespace {

/// A source in Python: an iterable of frames, with `cameras`.
class PythonSource final : public Source {
 public:
  explicit PythonSource(std::shared_ptr<Held> object) : object_(std::move(object)) {
    in_python([&] {
      const py::object& o = object_->get();
      if (!py::hasattr(o, "cameras") || !py::hasattr(o, "__iter__"))
        throw PluginError(
            "expected the attribute `cameras` and a method __iter__(self) that gives "
            "frames");
      cameras_ = o.attr("cameras").cast<std::vector<Camera>>();
      rate_ = py::getattr(o, "frame_rate", py::float_(30.0)).cast<double>();
      count_ = py::getattr(o, "frame_count", py::none()).cast<std::optional<int>>();
      live_ = py::getattr(o, "live", py::bool_(false)).cast<bool>();
    });
  }

 private:
  const std::vector<Camera>& do_cameras() const override { return cameras_; }
  double do_frame_rate() const override { return rate_; }
  std::optional<int> do_frame_count() const override { return count_; }
  bool do_live() const override { return live_; }

  std::optional<Frame> do_next() override {
    return in_python([&]() -> std::optional<Frame> {
      if (!frames_) frames_.emplace(py::reinterpret_steal<py::object>(begin()));
      const auto item = py::reinterpret_steal<py::object>(PyIter_Next(frames_->get().ptr()));
      if (!item && PyErr_Occurred()) throw py::error_already_set();
      if (!item) return std::nullopt;
      Frame frame;
      if (py::isinstance<Frame>(item)) {
        frame = *py::cast<std::shared_ptr<Frame>>(item);
      } else {
        frame.views = views_of(item);
        frame.time = next_ / rate_;
        frame.index = -1;
        if (frame.views.empty()) frame.problem = "there are no pictures";
      }
      if (frame.index < 0) frame.index = next_;
      next_ = frame.index < INT_MAX ? frame.index + 1 : frame.index;
      return frame;
    });
  }

  PyObject* begin() const {
    PyObject* frames = PyObject_GetIter(object_->get().ptr());
    if (!frames) throw py::error_already_set();
    return frames;
  }

  std::shared_ptr<Held> object_;
  std::optional<Held> frames_;  ///< the iterator
  std::vector<Camera> cameras_;
  double rate_ = 30;
  std::optional<int> count_;
  bool live_ = false;
  int next_ = 0;
};

}  // namespace

void add_source(py::module_& module) {
  py::class_<PythonSceneSource>(module, "Source",
                                "The frames of a scene's own source, an iterator. Session.source() "
                                "makes one.")
      .def_property_readonly(
          "cameras", [](const PythonSceneSource& s) { return s.source().cameras(); },
          "The calibrated cameras, in the order of a frame's views.")
      .def_property_readonly("frame_rate",
                             [](const PythonSceneSource& s) { return s.source().frame_rate(); })
      .def_property_readonly(
          "frame_count", [](const PythonSceneSource& s) { return s.source().frame_count(); },
          "Number of frames, or None if it is not known.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__",
           [](PythonSceneSource& self) { return std::make_shared<Frame>(self.next()); });
}

std::unique_ptr<Source> python_source(std::shared_ptr<Held> object) {
  return std::make_unique<PythonSource>(std::move(object));
}

}  // namespace hypotrack::python
