#include "hypotrack/api/renderer.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <atomic>

#include "arrays.hpp"

namespace hypotrack::python {
namespace {

/// A renderer with its scene.
class PythonRenderer {
 public:
  explicit PythonRenderer(const std::shared_ptr<Scene>& scene)
      : scene_(scene), renderer_(without_gil([&] { return std::make_unique<Renderer>(*scene); })) {}
  ~PythonRenderer() { end_without_gil(renderer_); }
  PythonRenderer(const PythonRenderer&) = delete;
  PythonRenderer& operator=(const PythonRenderer&) = delete;

  py::tuple render(const Numbers& array, const Camera& camera, const py::object& background,
                   double ambient, double diffuse, int samples) {
    const Busy busy(busy_, "renderer");
    const Eigen::VectorXd state = finite_vector_of(array, scene_->dimension(), "state");
    if (camera.width <= 0 || camera.height <= 0)
      throw DataError("camera: expected one with a size; Camera(size=(width, height))");
    cv::Mat behind;
    if (!background.is_none()) behind = picture_of(background, Pixels::color, "background");
    if (!behind.empty() && (behind.cols != camera.width || behind.rows != camera.height))
      throw DataError(fmt::format("background: expected the camera's size {} x {}, found {} x {}",
                                  camera.width, camera.height, behind.cols, behind.rows));
    RenderStyle style;
    style.ambient = ambient;
    style.diffuse = diffuse;
    style.samples = samples;
    const RenderedView view =
        without_gil([&] { return renderer_->render(state, camera, style, behind); });
    return py::make_tuple(array_of(view.color), array_of(view.depth), array_of(view.label));
  }

  std::string device() const { return renderer_->device(); }

 private:
  std::shared_ptr<Scene> scene_;
  std::unique_ptr<Renderer> renderer_;
  std::atomic<bool> busy_ = false;
};

}  // namespace

void add_renderer(py::module_& module) {
  py::class_<PythonRenderer>(
      module, "Renderer",
      "Draws a scene with OpenGL, without a window. Raises DeviceError where "
      "there is none.")
      .def(py::init<const std::shared_ptr<Scene>&>(), py::arg("scene").none(false))
      .def("render", &PythonRenderer::render, py::arg("state"), py::arg("camera"), py::kw_only(),
           py::arg("background") = py::none(), py::arg("ambient") = 1.0, py::arg("diffuse") = 0.0,
           py::arg("samples") = 4,
           "Returns what a camera sees of the scene in a state (D,): color uint8 (H, W, 3) BGR, "
           "depth float32 (H, W) in metres, 0 where nothing is, and label uint8 (H, W), 1 + the "
           "number of the model. `background` is a picture of the camera's size.")
      .def_property_readonly("device", &PythonRenderer::device);
}

}  // namespace hypotrack::python
