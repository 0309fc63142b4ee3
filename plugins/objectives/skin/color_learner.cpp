#include "color_learner.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "depth_range.hpp"
#include "silhouette.hpp"

namespace hypotrack::skin {
namespace {

/// How likely each pixel is foreground by its place: 1/2 on the silhouette's edge and rising to its
/// inside over as many pixels as the pose may be wrong by. Negative where the image is invalid.
cv::Mat1f place_prior(const cv::Mat1b& silhouette, const cv::Mat1b& valid, double pose_error) {
  cv::Mat1f inside, outside;
  cv::distanceTransform(silhouette, inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(silhouette == 0, outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Mat1f out;
  cv::exp((outside - inside) / pose_error, out);
  out = 1 / (1 + out);
  out.setTo(-1, valid == 0);
  return out;
}

/// Pixels per metre at the middle of the scene.
double scale_at(const Observation& observation, const TileCamera& camera) {
  const DepthRange range = depth_range(observation, camera, 0);
  const float middle = std::max((range.nearest + range.farthest) / 2, 0.01f);
  return camera.fx / double{middle};
}

/// Whether the image shows so much of the models that their colours can be told.
bool shows(const cv::Mat1b& silhouette, const cv::Mat1b& valid) {
  constexpr double kLeastShare = 0.1;
  const int shown = cv::countNonZero(silhouette & valid);
  return shown > 0 && shown >= kLeastShare * cv::countNonZero(silhouette);
}

}  // namespace

void ColorLearner::learn(const Observation& observation, const TileCamera& camera,
                         const cv::Mat3b& color, const cv::Mat1b& valid) {
  if (from_guess_ || observation.start_is_guess) *this = ColorLearner(settings_);
  last_seen_ = observation.frame;
  const cv::Mat1b models = silhouette(*observation.scene, observation.start, camera);
  if (!shows(models, valid)) {
    if (learned_ == 0) probabilities_.assign(kBins, 0.5f);
    return;
  }
  const double pose_error = settings_.pose_error * scale_at(observation, camera);
  colors_.add(color, place_prior(models, valid, std::max(pose_error, 0.1)));
  probabilities_ = colors_.probabilities();
  ++learned_;
  from_guess_ = observation.start_is_guess;
  if (!from_guess_) return;
  const auto trust = static_cast<float>(settings_.guess_trust);
  for (float& p : probabilities_) p = 0.5f + trust * (p - 0.5f);
}

}  // namespace hypotrack::skin
