#include "tracker.hpp"

#include <pybind11/stl.h>

#include <climits>

#include "arrays.hpp"

namespace hypotrack::python {

PythonTracker::PythonTracker(Tracker tracker)
    : tracker_(std::make_unique<Tracker>(std::move(tracker))),
      scene_(std::make_shared<Scene>(tracker_->scene())) {
  all().insert(this);
}

PythonTracker::~PythonTracker() {
  all().erase(this);
  end_without_gil(tracker_);
}

std::set<PythonTracker*>& PythonTracker::all() {
  static auto* const kAll = new std::set<PythonTracker*>;  // outlives Python
  return *kAll;
}

void PythonTracker::end_all() {
  const std::set<PythonTracker*> trackers = all();
  for (PythonTracker* tracker : trackers) {
    if (!all().contains(tracker) || tracker->busy_.exchange(true)) continue;
    end_without_gil(tracker->tracker_);
    tracker->busy_ = false;
  }
}

Tracker& PythonTracker::tracker() const {
  if (!tracker_) throw Error("this tracker has ended with the program");
  return *tracker_;
}

std::vector<Camera> PythonTracker::cameras() {
  const Busy busy(busy_, "tracker");
  return tracker().cameras();
}

std::string PythonTracker::backend() {
  const Busy busy(busy_, "tracker");
  return tracker().backend();
}

NamedSolution PythonTracker::track(Frame frame) {
  const Busy busy(busy_, "tracker");
  Tracker& tracker = this->tracker();
  if (frame.index < 0) frame.index = next_;
  const int next = frame.index < INT_MAX ? frame.index + 1 : frame.index;
  Interrupts interrupts;
  NamedSolution out{{}, scene_};
  try {
    without_gil([&] {
      out.solution = tracker.track(frame, [&] { return interrupts(); });
      out.notes = tracker.take_notes();
    });
  } catch (const Stopped&) {
    next_ = next;
    interrupts.rethrow();
    throw;
  }
  next_ = next;
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
      .def_property_readonly("cameras", &PythonTracker::cameras,
                             "The cameras, with the sizes of their pictures.")
      .def_property_readonly("backend", &PythonTracker::backend,
                             "What evaluates hypotheses: the CPU and its threads, or the GPU.");
  // Threads of a tracker may call Python, which is too late once Python ends.
  py::module_::import("atexit").attr("register")(py::cpp_function(&PythonTracker::end_all));
}

}  // namespace hypotrack::python
