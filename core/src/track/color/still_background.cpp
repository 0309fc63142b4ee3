#include "track/color/still_background.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "track/recover/silhouette.hpp"

namespace hypotrack::internal {
namespace {

/// Returns where pictures may show the models: their silhouettes and a margin for wrong poses.
cv::Mat1b around_models(const Scene& scene, const Eigen::VectorXd& state, const Camera& camera) {
  constexpr int kReduction = 4;
  constexpr double kMargin = 0.03;  // metres
  cv::Mat1b models =
      silhouettes(scene, std::vector<bool>(scene.items().size(), true), state, camera, kReduction);
  const Eigen::Vector3d origin =
      camera.camera_from_world * state.segment<3>(scene.items()[0].offset);
  const int margin = std::clamp(
      static_cast<int>(kMargin * camera.fx / std::max(origin.z(), 0.05) / kReduction), 1, 100);
  cv::dilate(models, models,
             cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * margin + 1, 2 * margin + 1}));
  cv::Mat1b out;
  cv::resize(models, out, {camera.width, camera.height}, 0, 0, cv::INTER_NEAREST);
  return out;
}

}  // namespace

StillBackground::StillBackground(const Scene& scene, std::vector<Camera> cameras)
    : scene_(scene), cameras_(std::move(cameras)), views_(cameras_.size()) {}

void StillBackground::learn(const Frame& frame, const Eigen::VectorXd& state) {
  tbb::parallel_for(std::size_t{0}, views_.size(), [&](std::size_t i) {
    const cv::Mat& picture = frame.views[i].color;
    if (!picture.empty()) views_[i].learn(picture, around_models(scene_, state, cameras_[i]));
  });
}

void StillBackground::add_to(TilePlan& plan, std::span<const Resampler> resamplers) const {
  tbb::parallel_for(std::size_t{0}, views_.size(), [&](std::size_t i) {
    if (!views_[i].has_learned()) return;
    TileView& tile = plan.header.views[i];
    tile.background = resamplers[i].resample_background(views_[i].background(plan.views[i].touched),
                                                        tile.camera, plan.views[i]);
  });
}

}  // namespace hypotrack::internal
