#include "hypotrack/api/renderer.hpp"

#include <fmt/format.h>

#include <deque>
#include <optional>

#include "hypotrack/api/error.hpp"
#include "picture/flat_drawer.hpp"
#include "picture/lens.hpp"
#include "picture/scene_drawer.hpp"

namespace hypotrack {
namespace {

constexpr std::size_t kLensesKept = 4;  // a distorted lens stores one ray per pixel

void check_arguments(const Scene& scene, const Eigen::VectorXd& state, const Camera& camera,
                     const cv::Mat& background) {
  if (state.size() != scene.dimension()) {
    throw DataError(fmt::format("cannot render a state of {} numbers: the scene has {} parameters",
                                state.size(), scene.dimension()));
  }
  if (!state.allFinite()) throw DataError("cannot render a state that is not finite");
  validate(camera, "the camera to render for");
  if (background.empty()) return;
  if (background.type() != CV_8UC3 || background.cols != camera.width ||
      background.rows != camera.height) {
    throw DataError(
        fmt::format("cannot render before a background of {}x{} pixels, {} channels of {} bytes: "
                    "expected an 8-bit "
                    "BGR image of the camera's size, {}x{}",
                    background.cols, background.rows, background.channels(), background.elemSize1(),
                    camera.width, camera.height));
  }
}

/// Composites a picture with coverage (premultiplied colour) over another.
void put_over(const cv::Mat& layer, cv::Mat target) {
  for (int y = 0; y < layer.rows; ++y) {
    const auto* from = layer.ptr<cv::Vec4b>(y);
    auto* to = target.ptr<cv::Vec3b>(y);
    for (int x = 0; x < layer.cols; ++x) {
      const int uncovered = 255 - from[x][3];
      if (uncovered == 255) continue;
      for (int c = 0; c < 3; ++c) {
        const int behind = (to[x][c] * uncovered + 127) / 255;
        to[x][c] = cv::saturate_cast<unsigned char>(from[x][c] + behind);
      }
    }
  }
}

}  // namespace

struct Renderer::Impl {
  explicit Impl(const Scene& s) : scene(s), flat(s) {}

  SceneDrawer& opengl() {
    if (!drawer) drawer.emplace(scene);
    return *drawer;
  }

  const LensRays& lens_of(const Camera& camera) {
    for (const LensRays& lens : lenses) {
      if (lens.fits(camera)) return lens;
    }
    if (lenses.size() == kLensesKept) lenses.pop_front();
    return lenses.emplace_back(camera);
  }

  const Scene& scene;
  FlatDrawer flat;
  std::optional<SceneDrawer> drawer;  // made when it is first needed
  std::deque<LensRays> lenses;
};

Renderer::Renderer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}

Renderer::~Renderer() = default;

std::string Renderer::device() const { return impl_->opengl().device(); }

RenderedView Renderer::render(const Eigen::VectorXd& state, const Camera& camera,
                              const RenderStyle& style, const cv::Mat& background) {
  check_arguments(impl_->scene, state, camera, background);
  const cv::Size size(camera.width, camera.height);
  RenderedView rendered;
  rendered.color = background.empty() ? cv::Mat::zeros(size, CV_8UC3) : background.clone();
  rendered.depth = cv::Mat::zeros(size, CV_32FC1);
  rendered.label = cv::Mat::zeros(size, CV_8UC1);

  const LensRays& lens = impl_->lens_of(camera);
  if (!style.textured) {
    impl_->flat.draw(state, lens, camera.camera_from_world, style, rendered);
    return rendered;
  }
  SceneDrawer& drawer = impl_->opengl();
  drawer.pose(state, style.hidden);
  const LensView view =
      lens.view(drawer.extent(camera.camera_from_world), camera.camera_from_world);
  if (view.roi.empty()) return rendered;
  cv::Mat color = drawer.draw_color(view.pinhole, style);
  Geometry geometry = drawer.draw_geometry(finer(view.pinhole, view.geometry_scale));
  if (!view.map.empty()) {
    color = sample_linear(color, view);
    geometry.depth = sample_nearest(geometry.depth, view);
    geometry.label = sample_nearest(geometry.label, view);
  }
  put_over(color, rendered.color(view.roi));
  geometry.depth.copyTo(rendered.depth(view.roi));
  geometry.label.copyTo(rendered.label(view.roi));
  return rendered;
}

}  // namespace hypotrack
