#include "color_learner.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "hypotrack/plugin/kinematics.hpp"
#include "rule.hpp"

namespace hypotrack::skin {
namespace {

constexpr int kShift = 4;  // fractional bits of fillConvexPoly's coordinates
constexpr float kNearest = 0.01f;
constexpr float kFarthest = 1e5f;  // in pixels; larger coordinates would overflow

/// Projects a vertex into a tile, in fillConvexPoly's units. Returns false if that is impossible.
bool project(const TileCamera& camera, const Eigen::Vector3f& p, cv::Point& pixel) {
  if (!(p.z() > kNearest)) return false;
  const float x = static_cast<float>(camera.fx) * p.x() / p.z() + static_cast<float>(camera.cx);
  const float y = static_cast<float>(camera.fy) * p.y() / p.z() + static_cast<float>(camera.cy);
  if (!(std::abs(x) < kFarthest) || !(std::abs(y) < kFarthest)) return false;
  pixel = {cvRound(x * (1 << kShift)), cvRound(y * (1 << kShift))};
  return true;
}

constexpr double kBeside = 0.08;  // metres from the silhouette within which background counts

/// Foreground prior of pixels by their place.
struct PlaceModel {
  cv::Mat1f prior;   ///< foreground probability; negative where the image is invalid
  cv::Mat1f weight;  ///< weight as background
};

/// Computes the prior: 1/2 on the silhouette's edge, 1 or 0 at the distance of the pose error.
/// Background counts near the silhouette only. Of a sleeve below the wrist, an equal share then
/// lies beside the hand and under the model's wrist.
PlaceModel model_places(const cv::Mat1b& silhouette, const cv::Mat1b& valid, double pose_error,
                        double beside) {
  cv::Mat1f inside, outside;
  cv::distanceTransform(silhouette, inside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(silhouette == 0, outside, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  PlaceModel out;
  cv::exp((outside - inside) / pose_error, out.prior);
  out.prior = 1 / (1 + out.prior);
  out.prior.setTo(-1, valid == 0);
  cv::exp(-outside / beside, out.weight);
  return out;
}

/// Returns the pixels per metre at the middle of the scene.
double scale_at(const Observation& observation, const TileCamera& camera) {
  const DepthRange range = depth_range(observation, camera, 0);
  const float middle = std::max((range.nearest + range.farthest) / 2, 0.01f);
  return camera.fx / double{middle};
}

/// Returns whether the image shows enough of the models to learn their colours.
bool shows(const cv::Mat1b& silhouette, const cv::Mat1b& valid) {
  constexpr double kLeastShare = 0.1;
  const int shown = cv::countNonZero(silhouette & valid);
  return shown > 0 && shown >= kLeastShare * cv::countNonZero(silhouette);
}

}  // namespace

cv::Mat1b silhouette(const Scene& scene, const Eigen::VectorXd& state, const TileCamera& camera) {
  cv::Mat1b out(camera.height, camera.width, uchar{0});
  const Eigen::Isometry3f view = camera.camera_from_world.cast<float>();
  for (const Scene::Item& item : scene.items()) {
    const Eigen::Matrix3Xf vertices = posed_vertices(*item.model, scene.part(item, state));
    const auto& triangles = item.model->data().mesh.triangles;
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
      cv::Point corners[3];
      bool drawn = true;
      for (int i = 0; i < 3; ++i) {
        drawn = drawn && project(camera, view * vertices.col(triangles(i, t)), corners[i]);
      }
      if (drawn) cv::fillConvexPoly(out, corners, 3, 255, cv::LINE_8, kShift);
    }
  }
  return out;
}

void ColorLearner::learn(const Observation& observation, const TileCamera& camera,
                         const cv::Mat3b& color, const cv::Mat1b& valid) {
  if (from_guess_ || observation.context.start_is_guess) *this = ColorLearner(settings_);
  last_seen_ = observation.frame;
  const cv::Mat1b models = silhouette(*observation.scene, observation.start, camera);
  if (!shows(models, valid)) {
    if (learned_ == 0) probabilities_.assign(kBins, 0.5f);
    if (learned_ == 0 && settings_.still_cameras) frequencies_.assign(kBins, {});
    return;
  }
  const double scale = scale_at(observation, camera);
  const PlaceModel places = model_places(models, valid, std::max(settings_.pose_error * scale, 0.1),
                                         std::max(kBeside * scale, 1.0));
  colors_.add(color, places.prior, places.weight);
  probabilities_ = colors_.probabilities();
  if (settings_.still_cameras) frequencies_ = colors_.color_frequencies();
  ++learned_;
  from_guess_ = observation.context.start_is_guess;
  if (!from_guess_) return;
  const auto trust = static_cast<float>(settings_.guess_trust);
  for (float& p : probabilities_) p = 0.5f + trust * (p - 0.5f);
}

}  // namespace hypotrack::skin
