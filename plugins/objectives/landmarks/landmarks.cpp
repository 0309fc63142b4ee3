#include "landmarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "hand_detector.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/kinematics.hpp"
#include "hypotrack/observation_checks.hpp"

namespace hypotrack::landmarks {

Landmarks::Landmarks(const Params& params, const Scene& scene, Detector detector)
    : params_(params), scene_(scene), finder_(std::move(detector)) {
  for (const Scene::Item& item : scene.items()) {
    if (const auto hand = hand_model(*item.model)) hands_.push_back({&item, *hand});
  }
}

void Landmarks::prepare(const Observation& observation) {
  sights_.clear();
  std::vector<HandPoints3D> starts;
  for (const Hand& hand : hands_) {
    const auto part = scene_.part(*hand.item, observation.start);
    starts.push_back(hand.model.in_detector_order(posed_landmarks(*hand.item->model, part)));
    sights_.push_back({hand.item->model.get(), hand.item->offset});
  }
  std::size_t views = 0;
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    if (observation.views[i].color.empty()) continue;
    take_view(observation, i, starts);
    ++views;
  }
  if (views == 0) {
    throw DataError(
        "landmarks: no view has a colour image; take a source with colour, or leave the objective "
        "out");
  }
  for (HandSights& hand : sights_) {
    for (Sight& sight : hand.sights) sight.factor /= std::sqrt(static_cast<double>(views));
  }
}

void Landmarks::take_view(const Observation& observation, std::size_t view,
                          std::span<const HandPoints3D> starts) {
  const TileView& tile = observation.views[view];
  check_tile_image("landmarks", tile.color, CV_8UC3, tile, view, "colour image");
  std::vector<WantedHand> wanted;
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    wanted.push_back({directions_to(starts[i], tile.camera), hands_[i].model.right});
  }
  const auto found = finder_.find(observation, view, wanted, starts);
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    take_hand(sights_[i], hands_[i].model, tile.camera, found[i]);
  }
}

void Landmarks::take_hand(HandSights& sights, const HandModel& model, const TileCamera& camera,
                          const std::optional<SeenHand>& seen) const {
  for (std::size_t i = 0; i < model.landmarks.size(); ++i) {
    if (model.landmarks[i] < 0) continue;
    Sight sight{.landmark = model.landmarks[i]};
    if (seen) {
      sight.eye = eye_of(camera);
      sight.along = seen->directions.col(static_cast<Eigen::Index>(i));
      sight.distance = seen->distance;
      sight.factor = std::pow(seen->presence, params_.presence_power / 2);
    }
    sights.sights.push_back(sight);
  }
}

double Landmarks::cost(const RenderedHypothesis& hypothesis) const {
  return cost_and_residuals(hypothesis, {});
}

void Landmarks::write_residuals(const RenderedHypothesis& hypothesis,
                                std::span<float> residuals) const {
  cost_and_residuals(hypothesis, residuals);
}

double Landmarks::cost_and_residuals(const RenderedHypothesis& hypothesis,
                                     std::span<float> residuals) const {
  return landmarks::cost_and_residuals(sights_, {params_.free, params_.sigma}, hypothesis.state,
                                       residuals);
}

bool Landmarks::has_jacobian() const {
  return std::ranges::none_of(hands_,
                              [](const Hand& hand) { return hand.item->model->poses_itself(); });
}

void Landmarks::write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                               Jacobian& jacobian) const {
  cost_and_residuals(hypothesis, residuals);
  landmarks::write_jacobian(sights_, {params_.free, params_.sigma}, hypothesis.state, jacobian);
}

Detector networks(const LandmarksParams& params, const Scene& scene) {
  if (std::ranges::none_of(scene.items(), [](const Scene::Item& item) {
        return hand_model(*item.model).has_value();
      })) {
    return {};
  }
  const auto detector =
      std::make_shared<HandDetector>(HandDetector::Options{.folder = params.folder,
                                                           .lite = params.lite,
                                                           .presence = params.least_presence,
                                                           .smallest_hand = 0});
  return {
      .detect = [detector](const cv::Mat& picture) { return detector->detect(picture); },
      .refine = [detector](const cv::Mat& picture,
                           const HandPoints& guess) { return detector->refine(picture, guess); }};
}

}  // namespace hypotrack::landmarks
