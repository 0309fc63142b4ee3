#include "tracker.hpp"

#include <pybind11/stl.h>

#include "frames.hpp"

namespace hypotrack::python {

NamedSolution PythonTracker::track(Frame frame) {
  const Busy busy(busy_, "tracker");
  if (frame.index < 0) frame.index = next_;
  Interrupts interrupts;
  NamedSolution out{{}, scene_};
  try {
    without_gil([&] {
      out.solution = tracker_->track(frame, [&] { return interrupts(); });
      out.notes = tracker_->take_notes();
    });
  } catch (const Stopped&) {
    next_ = frame.index + 1;
    interrupts.rethrow();
    throw;
  }
  next_ = frame.index + 1;
  return out;
}

namespace {

Frame frame_of(std::vector<View> views, double time, std::optional<int> index) {
  Frame frame;
  frame.views = std::move(views);
  frame.time = time;
  frame.index = index.value_or(-1);
  if (frame.views.empty()) frame.problem = "there are no pictures";
  return frame;
}

}  // namespace

void add_tracker(py::module_& module) {
  py::class_<PythonTracker>(
      module, "Tracker",
      "Tracks a scene through frames that the program hands over, in their order. "
      "Session.tracker() "
      "makes one. Use it from one thread at a time; other threads of Python go on meanwhile.")
      .def(
          "track",
          [](PythonTracker& self, const py::array& left, const py::array& right, double time,
             std::optional<int> index) {
            return self.track(
                frame_of({view_of(left, "left"), view_of(right, "right")}, time, index));
          },
          py::arg("left"), py::arg("right"), py::arg("time"), py::kw_only(),
          py::arg("index") = py::none(),
          "Finds the scene in two pictures, uint8 (H, W, 3) in the order blue, green, red. They "
          "are "
          "not copied: leave them as they are until the next frame is tracked. `time` is in "
          "seconds. Raises DataError if they do not fit the cameras or the frames before.")
      .def(
          "track",
          [](PythonTracker& self, const py::object& views, double time, std::optional<int> index) {
            return self.track(frame_of(views_of(views), time, index));
          },
          py::arg("views"), py::arg("time"), py::kw_only(), py::arg("index") = py::none(),
          "Finds the scene in a list of pictures or Views, one per camera. None or an empty list: "
          "the frame is missing.")
      .def(
          "track", [](PythonTracker& self, const Frame& frame) { return self.track(frame); },
          py::arg("frame"), "Finds the scene in a Frame, such as one of a Source.")
      .def_property_readonly("scene", &PythonTracker::scene)
      .def_property_readonly(
          "cameras", [](const PythonTracker& self) { return self.tracker().cameras(); },
          "The cameras, with the sizes of their pictures.")
      .def_property_readonly(
          "backend", [](const PythonTracker& self) { return self.tracker().backend(); },
          "What evaluates hypotheses: the CPU and its threads, or the GPU.");
}

}  // namespace hypotrack::python
