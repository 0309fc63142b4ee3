#include "source.hpp"

#include <pybind11/stl.h>

namespace hypotrack::python {

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

}  // namespace hypotrack::python
