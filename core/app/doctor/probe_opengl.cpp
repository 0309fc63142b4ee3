#include <fmt/format.h>

#include <memory>

#include "doctor/probe.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/renderer.hpp"

namespace hypotrack::doctor {
namespace {

Mesh tetrahedron(float half) {
  Mesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 1, -1, -1, 1,  //
      1, -1, 1, -1,               //
      1, 1, -1, -1;
  mesh.vertices *= half;
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 0, 1,  //
      2, 1, 3, 2,                //
      1, 3, 2, 3;
  return mesh;
}

/// Draws a tetrahedron in front of a camera. Returns whether it is in the picture.
bool draws(Renderer& renderer, const Scene& scene) {
  constexpr int kSize = 64;
  Eigen::VectorXd state = scene.rest_state();
  state[2] = 0.5;  // metres in front of the camera
  Camera camera;
  camera.width = camera.height = kSize;
  camera.fx = camera.fy = kSize;
  camera.cx = camera.cy = (kSize - 1) / 2.0;
  const RenderedView view = renderer.render(state, camera, {});
  const float depth = view.depth.at<float>(kSize / 2, kSize / 2);
  return view.label.at<unsigned char>(kSize / 2, kSize / 2) == 1 && depth > 0.35F &&
         depth < 0.65F && view.label.at<unsigned char>(0, 0) == 0;
}

}  // namespace

Check probe_opengl() {
  constexpr float kHalf = 0.1F;  // metres
  const std::string mesa = "sudo apt-get install libegl-mesa0 libgl1-mesa-dri, or NVIDIA's driver";
  const Scene scene({{"tetrahedron", std::make_shared<Model>(rigid_model(tetrahedron(kHalf)))}});
  try {
    Renderer renderer(scene);
    if (draws(renderer, scene)) return {.found = renderer.device() + "; draws"};
    return {.state = State::broken,
            .found = renderer.device() + "; a picture that it drew is wrong",
            .fix = "update the driver, or take Mesa's: " + mesa};
  } catch (const DeviceError& e) {
    const std::string text = e.what();
    const bool absent = text.find("libEGL.so.1 cannot be opened") != std::string::npos;
    const std::size_t advice = text.rfind("install a driver with EGL");
    return {.state = absent ? State::missing : State::broken,
            .found = text.substr(0, text.find_last_not_of("; \n", advice - 1) + 1),
            .fix = mesa};
  }
}

}  // namespace hypotrack::doctor
