#include <fmt/format.h>
#include <pybind11/stl.h>

#include <memory>

#include "arrays.hpp"

namespace hypotrack::python {
namespace {

View make_view(const py::object& color, const py::object& depth, const py::object& mask) {
  View view;
  if (!color.is_none()) view.color = picture_of(color, Pixels::color, "color");
  if (!depth.is_none()) view.depth = picture_of(depth, Pixels::depth, "depth");
  if (!mask.is_none()) view.mask = picture_of(mask, Pixels::mask, "mask");
  if (view.color.empty() && view.depth.empty())
    throw DataError("a view needs a picture: color, depth or both");
  return view;
}

py::object truth_state(const Frame& frame) {
  if (!frame.truth || frame.truth->state.size() == 0) return py::none();
  return array_of(frame.truth->state);
}

py::object truth_landmarks(const Frame& frame) {
  if (!frame.truth || frame.truth->landmarks.size() == 0) return py::none();
  return points_of(frame.truth->landmarks);
}

Frame make_frame(const py::object& views, double time, int index, const py::object& state,
                 const py::object& landmarks) {
  Frame frame;
  frame.views = views_of(views);
  frame.time = time;
  frame.index = index;
  if (!state.is_none() || !landmarks.is_none()) frame.truth.emplace();
  if (!state.is_none()) frame.truth->state = vector_of(numbers_of(state), "true_state");
  if (!landmarks.is_none())
    frame.truth->landmarks = matrix_of_points(numbers_of(landmarks), "true_landmarks");
  if (frame.views.empty()) frame.problem = "there are no pictures";
  return frame;
}

}  // namespace

View view_of(const py::handle& object, const std::string& what) {
  if (py::isinstance<View>(object)) return py::cast<View>(object);
  View view;
  view.color = picture_of(object, Pixels::color, what);
  return view;
}

std::vector<View> views_of(const py::handle& objects) {
  std::vector<View> views;
  if (objects.is_none()) return views;
  if (!py::isinstance<py::list>(objects) && !py::isinstance<py::tuple>(objects))
    throw DataError("views: expected a list with a picture or View for each camera");
  for (const py::handle object : objects)
    views.push_back(view_of(object, fmt::format("view {}", views.size())));
  return views;
}

void add_frames(py::module_& module) {
  py::class_<View>(module, "View", "The pictures of one camera. They share the arrays' memory.")
      .def(py::init(&make_view), py::arg("color") = py::none(), py::arg("depth") = py::none(),
           py::arg("mask") = py::none(),
           "Takes `color`, uint8 (H, W, 3) in the order blue, green, red; `depth`, float32 (H, W), "
           "z in metres, 0 where nothing was measured; `mask`, uint8 (H, W), not 0 in the "
           "foreground. Rows must be contiguous.")
      .def_property_readonly(
          "color", [](const View& v) { return array_of(v.color); },
          "Read-only array uint8 (H, W, 3), BGR, or None.")
      .def_property_readonly(
          "depth", [](const View& v) { return array_of(v.depth); },
          "Read-only array float32 (H, W), metres, or None.")
      .def_property_readonly(
          "mask", [](const View& v) { return array_of(v.mask); },
          "Read-only array uint8 (H, W), or None.");
  py::class_<Frame, std::shared_ptr<Frame>>(module, "Frame", "All views of one instant.")
      .def(py::init(&make_frame), py::arg("views"), py::arg("time"), py::arg("index") = -1,
           py::arg("true_state") = py::none(), py::arg("true_landmarks") = py::none(),
           "Takes a list of Views or colour pictures, one per camera (empty: no usable frame), and "
           "the time in seconds. An index of -1 is the next one of a source. `true_state` (D,) and "
           "`true_landmarks` (L, 3), metres, NaN where unknown, are the ground truth.")
      .def_readonly("index", &Frame::index, "Number within the source.")
      .def_readonly("time", &Frame::time, "Seconds since the first frame.")
      .def_property_readonly(
          "views", [](const Frame& f) { return py::cast(f.views); },
          "A View for each camera; empty if the frame cannot be used.")
      .def_readonly("problem", &Frame::problem, "Why there are no views; else empty.")
      .def_property_readonly("true_state", &truth_state, "True state (D,), or None.")
      .def_property_readonly("true_landmarks", &truth_landmarks,
                             "True landmarks (L, 3) in metres, NaN where unknown, or None.");
}

}  // namespace hypotrack::python
