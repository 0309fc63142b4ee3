#include "cost/gl/egl_drawer.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "cost/draw/raster_kernels.hpp"
#include "cost/gl/egl_scene.hpp"
#include "gl/egl_context.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

EglView make_view(const TileCamera& c, const Eigen::Isometry3d& first_from_world) {
  constexpr double kNearZ = kNear, kFarZ = kFar;
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  clip(0, 0) = 2 * c.fx / c.width;
  clip(0, 2) = 2 * (c.cx + 0.5) / c.width - 1;
  clip(1, 1) = 2 * c.fy / c.height;
  clip(1, 2) = 2 * (c.cy + 0.5) / c.height - 1;
  clip(2, 2) = (kFarZ + kNearZ) / (kFarZ - kNearZ);
  clip(2, 3) = -2 * kFarZ * kNearZ / (kFarZ - kNearZ);
  clip(3, 2) = 1;
  const Eigen::Isometry3d camera_from_first = c.camera_from_world * first_from_world.inverse();
  return {(clip * camera_from_first.matrix()).cast<float>(), c.width, c.height};
}

/// Returns a size that holds every view, with rows padded to whole blocks.
LayerSize tile_size(const Observation& observation) {
  LayerSize size;
  for (const TileView& view : observation.views) {
    size.width = std::max(size.width, (view.camera.width + kBlock - 1) / kBlock * kBlock);
    size.height = std::max(size.height, view.camera.height);
  }
  return size;
}

}  // namespace

struct EglDrawer::Impl {
  explicit Impl(const Scene& s) {
    const gl::CurrentContext current(context);
    EglScene made(s);  // on failure, OpenGL objects are deleted while their context is current
    most_hypotheses = made.most_hypotheses();
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most_layers);
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    scene = std::move(made);
  }

  ~Impl() {
    const gl::CurrentContext current(context);
    scene.reset();
  }

  gl::Context context;
  std::optional<EglScene> scene;
  int most_hypotheses = 0;
  int most_layers = 0;
  int largest = 0;  // width or height of a layer

  Eigen::Isometry3d first_from_world = Eigen::Isometry3d::Identity();
  std::vector<EglView> views;
  LayerSize tile;
};

EglDrawer::EglDrawer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}

EglDrawer::~EglDrawer() = default;

int EglDrawer::views() const { return static_cast<int>(impl_->views.size()); }

const gl::Context& EglDrawer::context() const { return impl_->context; }

Eigen::Index EglDrawer::largest_batch() const {
  return std::min(impl_->most_layers / std::max(views(), 1), impl_->most_hypotheses);
}

LayerSize EglDrawer::layers_for(Eigen::Index hypotheses) const {
  return {impl_->tile.width, impl_->tile.height, static_cast<int>(hypotheses) * views()};
}

void EglDrawer::prepare(const Observation& observation) {
  const LayerSize tile = tile_size(observation);
  if (std::max(tile.width, tile.height) > impl_->largest) {
    throw DeviceError(
        fmt::format("evaluate: tiles of {}x{} pixels exceed what this OpenGL can draw to, {}x{}; "
                    "use a smaller tile.size or backend: cpu",
                    tile.width, tile.height, impl_->largest, impl_->largest));
  }
  impl_->tile = tile;
  impl_->views.clear();
  if (observation.views.empty()) return;
  impl_->first_from_world = observation.views.front().camera.camera_from_world;
  for (const TileView& view : observation.views) {
    impl_->views.push_back(make_view(view.camera, impl_->first_from_world));
  }
}

void EglDrawer::draw(const Eigen::Ref<const Eigen::MatrixXd>& states, const EglLayers& to) {
  const gl::CurrentContext current(impl_->context);
  impl_->scene->pose(states, impl_->first_from_world);
  to.begin();
  glEnable(GL_SCISSOR_TEST);
  impl_->scene->draw(states, impl_->views);
  gl::check_errors("drawing hypotheses");
}

}  // namespace hypotrack::internal
