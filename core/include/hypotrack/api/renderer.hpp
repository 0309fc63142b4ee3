#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/export.hpp"
#include "hypotrack/api/scene.hpp"

namespace hypotrack {

/// Lighting and composition of a picture.
struct RenderStyle {
  double ambient = 1.0;   ///< share of the surface colour without light
  double diffuse = 0.0;   ///< Lambert term of one distant light
  double specular = 0.0;  ///< Blinn-Phong term
  double shininess = 30.0;
  Eigen::Vector3d light_direction{0.3, -0.5, 1.0};  ///< in which the light travels, world frame
  bool textured = true;        ///< false: a flat colour per model, drawn on the CPU (overlays)
  int samples = 4;             ///< antialiasing of textured pictures, samples per pixel
  std::vector<bool> hidden{};  ///< for each model, true to leave it out; empty = draw all
};

/// A rendered view with pixel (0, 0) at the top left.
struct RenderedView {
  cv::Mat color;  ///< 8-bit BGR, antialiased against `background` (or black)
  cv::Mat depth;  ///< 32-bit float z in metres, one sample at the pixel centre; 0 = nothing
  cv::Mat label;  ///< 8-bit: 0 = nothing, else 1 + index of the model in the scene
};

/// Draws a scene: in flat colours on the CPU, textured with OpenGL. The first textured picture
/// makes a surfaceless EGL context, of NVIDIA's driver if present, else of Mesa's software
/// rasteriser. Use it from one thread at a time.
class HYPOTRACK_API Renderer {
 public:
  /// The scene must outlive the renderer.
  explicit Renderer(const Scene& scene);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Draws the scene in one state as a camera sees it, lens distortion included. `background` is
  /// empty or has the camera's size. Throws DataError on what cannot be drawn, DeviceError if a
  /// textured picture gets no context.
  RenderedView render(const Eigen::VectorXd& state, const Camera& camera, const RenderStyle& style,
                      const cv::Mat& background = {});

  /// Returns OpenGL's vendor, renderer and version. Throws DeviceError if no context can be made.
  std::string device() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hypotrack
