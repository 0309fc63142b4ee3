#include "landmarks.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

#include "hand_detector.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/stop.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::landmarks {
namespace {

/// Returns how many threads look at a view: other terms need the rest meanwhile.
int threads_of_a_view() {
  constexpr int kShare = 4, kMost = 4;  // more than four gain little
  return std::clamp(tbb::this_task_arena::max_concurrency() / kShare, 1, kMost);
}

}  // namespace

Landmarks::Landmarks(const Params& params, const Scene& scene, Detector detector, PluginLog log)
    : params_(params), log_(std::move(log)), scene_(scene), finder_(std::move(detector)) {
  for (const Scene::Item& item : scene.items()) {
    if (const auto hand = hand_model(*item.model)) hands_.push_back({&item, *hand});
  }
}

void Landmarks::do_prepare(const Observation& observation) {
  sights_.clear();
  for (const Hand& hand : hands_) sights_.push_back({hand.item->model.get(), hand.item->offset});
  std::vector<std::size_t> views;  // with colour
  for (std::size_t i = 0; i < observation.views.size(); ++i) {
    const TileView& tile = observation.views[i];
    if (tile.color.empty()) continue;
    check_tile_image("landmarks", tile.color, CV_8UC3, tile, i, "colour image");
    views.push_back(i);
  }
  if (views.empty()) {
    throw DataError(
        "landmarks: no view has a colour image; take a source with colour, or leave the objective "
        "out");
  }
  check_stop();
  const std::vector<ModelHand> models = model_hands(observation);
  std::vector<std::vector<std::optional<SeenHand>>> found(views.size());
  tbb::parallel_for(std::size_t{0}, views.size(),
                    [&](std::size_t i) { found[i] = finder_.find(observation, views[i], models); });
  for (std::size_t i = 0; i < views.size(); ++i) {
    const TileCamera& camera = observation.views[views[i]].camera;
    for (std::size_t h = 0; h < hands_.size(); ++h) {
      if (overlaps_another(observation, camera, models, h)) found[i][h].reset();
      take_hand(sights_[h], hands_[h].model, camera, found[i][h]);
    }
  }
  check_sides(observation, views, models);
  for (HandSights& hand : sights_) {
    for (Sight& sight : hand.sights) sight.factor /= std::sqrt(static_cast<double>(views.size()));
  }
}

bool Landmarks::overlaps_another(const Observation& observation, const TileCamera& camera,
                                 const std::vector<ModelHand>& models, std::size_t hand) const {
  const auto position = [&](std::size_t h) {
    return observation.start.segment<3>(hands_[h].item->offset);
  };
  for (std::size_t h = 0; h < models.size(); ++h) {
    // A hidden model has the position of a shown one.
    if (h == hand || position(h) == position(hand)) continue;
    if (overlap(directions_to(models[h].start, camera), directions_to(models[hand].start, camera)))
      return true;
  }
  return false;
}

void Landmarks::check_sides(const Observation& observation, const std::vector<std::size_t>& views,
                            const std::vector<ModelHand>& models) {
  for (std::size_t h = 0; h < hands_.size(); ++h) {
    const bool is_other = std::ranges::all_of(views, [&](std::size_t view) {
      return finder_.saw_other_side(observation, view, models[h]);
    });
    if (hands_[h].side.add(observation.frame, is_other))
      log_.warning(hands::wrong_side_text(hands_[h].item->name, hands_[h].model.right, true));
  }
}

std::vector<ModelHand> Landmarks::model_hands(const Observation& observation) const {
  std::vector<ModelHand> out;
  for (const Hand& hand : hands_) {
    const auto points = [&](const Eigen::VectorXd& state) {
      return hand.model.in_detector_order(
          posed_landmarks(*hand.item->model, scene_.part(*hand.item, state)));
    };
    ModelHand& added = out.emplace_back();
    added.start = points(observation.start);
    if (observation.context.previous) added.previous = points(observation.context.previous->state);
    added.right = hand.model.right;
  }
  return out;
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

double Landmarks::do_cost(const RenderedHypothesis& hypothesis) const {
  return do_cost_and_residuals(hypothesis, {});
}

void Landmarks::do_write_residuals(const RenderedHypothesis& hypothesis,
                                   std::span<float> residuals) const {
  do_cost_and_residuals(hypothesis, residuals);
}

double Landmarks::do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                                        std::span<float> residuals) const {
  return landmarks::cost_and_residuals(sights_, {params_.free, params_.sigma}, hypothesis.state,
                                       residuals);
}

bool Landmarks::do_has_jacobian() const {
  return std::ranges::none_of(hands_,
                              [](const Hand& hand) { return hand.item->model->poses_itself(); });
}

void Landmarks::do_write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                                  Jacobian& jacobian) const {
  do_cost_and_residuals(hypothesis, residuals);
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
  return {.detect = [detector](const cv::Mat& picture) { return detector->detect(picture); },
          .refine =
              [detector](const cv::Mat& picture, const HandPoints& guess, bool followed) {
                return followed ? detector->follow(picture, guess, threads_of_a_view())
                                : detector->refine(picture, guess, threads_of_a_view());
              }};
}

}  // namespace hypotrack::landmarks
