#include "tile/tiles.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "camera/rectification.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/model.hpp"
#include "scene/posed_scene.hpp"
#include "scene/simd_kernels.hpp"
#include "scene/visible_share.hpp"
#include "tile/foreground_overlap.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kLargestZoom = 16.0;  // tile pixels per image pixel

std::vector<Camera> checked(std::vector<Camera> cameras) {
  if (cameras.empty()) throw DataError("the source has no cameras; expected at least one");
  for (std::size_t i = 0; i < cameras.size(); ++i)
    validate(cameras[i], fmt::format("camera {}", i));
  return cameras;
}

double sharpest(const std::vector<Camera>& cameras) {
  double focal = 0;
  for (const Camera& camera : cameras) focal = std::max({focal, camera.fx, camera.fy});
  return focal;
}

/// Returns the larger side of a model's image on the plane z = 1 of the first ideal camera.
double extent_of(const ScenePlan::Part& part, const ScenePoser& vertices) {
  constexpr std::array<float, 12> kFirst{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  const std::size_t first = part.first_vertex;
  const std::size_t blocks = (std::size_t{part.vertex_count} + kBlock - 1) / kBlock;
  PlaneBounds bounds{};
  bound_points(vertices.x() + first, vertices.y() + first, vertices.z() + first, blocks * kBlock,
               kFirst.data(), bounds);
  return std::max(double{bounds.x1} - bounds.x0, double{bounds.y1} - bounds.y0);
}

/// Returns how many times as large as the largest of several rigid models they are together, in the
/// first view; 1 if a model has joints.
double times_as_large(const PosedScene& posed) {
  double largest = 0;
  for (const ScenePlan::Part& part : posed.plan().parts) {
    if (posed.leaves_out(part)) continue;
    if (part.item->model->dimension() != kPoseSize) return 1;
    largest = std::max(largest, extent_of(part, posed.vertices()));
  }
  const Bounds& all = posed.bounds()[0];
  return largest > 0 ? std::max(all.width(), all.height()) / largest : 1;
}

}  // namespace

struct TileMaker::Impl {
  Impl(const Scene& s, std::vector<Camera> c, const TileSettings& t)
      : scene(s),
        cameras(checked(std::move(c))),
        settings(t),
        rig(make_ideal_rig(cameras)),
        posed(scene, rig),
        visible(cameras, rig) {
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      resamplers.emplace_back(cameras[i], rig.camera_from_ideal[i]);
    }
  }

  std::vector<ResamplePlan> plan_views(const std::vector<TileCamera>& tiles) const;
  int tile_size() const;

  const Scene& scene;
  std::vector<Camera> cameras;
  TileSettings settings;
  IdealRig rig;
  PosedScene posed;
  VisibleShare visible;
  std::vector<Resampler> resamplers;
};

/// Returns the side of the tiles around the posed scene. A tile that several rigid models share is
/// larger, so that the largest is not shown too small to be followed, but not finer than the
/// pictures.
int TileMaker::Impl::tile_size() const {
  constexpr double kMost = 2;  // times the size of the settings: four times its time
  constexpr int kStep = 32;    // pixels, so that few frames change it
  const Bounds& all = posed.bounds()[0];
  const double pixels =
      std::max(all.width(), all.height()) * (1 + 2 * settings.padding) * sharpest(cameras);
  const double wanted = std::min(settings.size * std::min(times_as_large(posed), kMost), pixels);
  if (!(wanted > settings.size)) return settings.size;
  return settings.size + kStep * static_cast<int>((wanted - settings.size) / kStep);
}

std::vector<ResamplePlan> TileMaker::Impl::plan_views(const std::vector<TileCamera>& tiles) const {
  std::vector<double> scales;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    scales.push_back(scale_at_centre(resamplers[i].lens(), tiles[i]));
  }
  // A pair is compared pixel by pixel, so both views must be smoothed equally.
  if (rig.rectified) scales[0] = scales[1] = std::sqrt(scales[0] * scales[1]);
  std::vector<ResamplePlan> plans;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    plans.push_back(
        plan_resampling(resamplers[i].lens(), tiles[i], resamplers[i].image_size(), scales[i]));
  }
  return plans;
}

TileMaker::TileMaker(const Scene& scene, std::vector<Camera> cameras, const TileSettings& settings)
    : impl_(std::make_unique<Impl>(scene, std::move(cameras), settings)) {}
TileMaker::~TileMaker() = default;

bool TileMaker::rectifies() const { return impl_->rig.rectified; }
std::span<const Resampler> TileMaker::resamplers() const { return impl_->resamplers; }

const Scene& TileMaker::scene() const { return impl_->scene; }

const PosedScene& TileMaker::posed(const Eigen::VectorXd& state) const {
  impl_->posed.pose(state);
  return impl_->posed;
}

void TileMaker::leave_out(const std::vector<bool>& models) { impl_->posed.leave_out(models); }

double TileMaker::visible_share(const Eigen::VectorXd& state) const {
  return impl_->visible.of(posed(state));
}

ForegroundOverlap TileMaker::foreground_overlap(const Frame& frame,
                                                const Eigen::VectorXd& state) const {
  check_views(frame, impl_->cameras);
  return hypotrack::foreground_overlap(posed(state), impl_->rig.ideal_from_world[0].inverse(),
                                       impl_->cameras, frame.views);
}

TilePlan TileMaker::plan(const Frame& frame, const Eigen::VectorXd& state) const {
  Impl& self = *impl_;
  check_views(frame, self.cameras);
  const double largest_focal = kLargestZoom * sharpest(self.cameras);
  self.posed.pose(state);
  self.posed.check_in_front();
  const std::vector<TileCamera> tiles =
      crop(self.posed.bounds(), self.rig, self.tile_size(), self.settings.padding, largest_focal);
  TilePlan plan;
  plan.header.frame = frame.index;
  plan.header.time = frame.time;
  plan.header.scene = &self.scene;
  plan.header.start = state;
  plan.header.rectified = self.rig.rectified;
  plan.header.views.resize(tiles.size());
  for (std::size_t i = 0; i < tiles.size(); ++i) plan.header.views[i].camera = tiles[i];
  plan.views = self.plan_views(tiles);
  return plan;
}

Observation TileMaker::resample(const Frame& frame, const TilePlan& plan) const {
  Observation observation = plan.header;
  tbb::parallel_for(std::size_t{0}, plan.views.size(), [&](std::size_t i) {
    const TileCamera& tile = plan.header.views[i].camera;
    TileView view = impl_->resamplers[i].resample(frame.views[i], tile, plan.views[i]);
    view.background = plan.header.views[i].background;
    observation.views[i] = std::move(view);
  });
  return observation;
}

Observation TileMaker::make(const Frame& frame, const Eigen::VectorXd& state) const {
  return resample(frame, plan(frame, state));
}

}  // namespace hypotrack::internal
