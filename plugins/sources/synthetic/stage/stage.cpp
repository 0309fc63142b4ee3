#include "stage/stage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"

namespace hypotrack::synthetic {
namespace {

using Models = std::vector<std::pair<std::string, std::shared_ptr<const Model>>>;

/// Returns the tracked models or their replacements.
Models models_to_draw(const Scene& tracked, const ConfigNode& render_models,
                      PluginContext& context) {
  Models models;
  std::vector<std::string> names;
  for (const Scene::Item& item : tracked.items()) {
    const ConfigNode other = render_models.get(item.name);
    models.emplace_back(item.name, other.defined()
                                       ? std::shared_ptr<const Model>(context.make<Model>(other))
                                       : item.model);
    names.push_back(item.name);
  }
  for (const std::string& name : render_models.keys()) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw ConfigError(fmt::format("{}: '{}' is no model of this scene; its models are: {}",
                                  render_models.get(name).where(), name, fmt::join(names, ", ")));
  }
  return models;
}

/// Returns the bone at a hand's wrist; nothing for other models.
std::optional<int> wrist_bone(const Model& model) {
  for (const Landmark& landmark : model.data().landmarks) {
    if (landmark.name == "wrist") return landmark.bone;
  }
  return std::nullopt;
}

int place_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

std::vector<std::string> parameter_names(const Model& model) {
  std::vector<std::string> names;
  for (const Parameter& p : model.data().parameters) names.push_back(p.name);
  return names;
}

}  // namespace

Stage::Stage(const Scene& tracked, const ConfigNode& render_models, const ForearmParams& forearm,
             std::vector<Card> cards, PluginContext& context)
    : models_(tracked.items().size()),
      others_(render_models.defined() && render_models.size() > 0),
      cards_(std::move(cards)) {
  if (render_models.defined() && !render_models.is_map()) {
    throw ConfigError(render_models.where() + ": expected a map of names of models to {type, ...}");
  }
  Models models = models_to_draw(tracked, render_models, context);
  if (forearm.kind != ForearmKind::none) {
    for (std::size_t m = 0; m < models_; ++m) {
      const std::optional<int> bone = wrist_bone(*models[m].second);
      if (!bone) continue;
      forearms_.push_back({m, *bone, 0});
      models.emplace_back(
          models[m].first + ".forearm",
          std::make_shared<Model>(make_forearm(models[m].second->data(), *bone, forearm)));
    }
    if (forearms_.empty()) {
      throw ConfigError(context.config().where() +
                        ": a forearm needs a hand, a model with a landmark `wrist`; use `forearm: "
                        "{kind: none}`");
    }
  }
  for (const Card& card : cards_)
    models.emplace_back(fmt::format("card_{}", models.size()),
                        std::make_shared<Model>(card.data()));
  scene_ = std::make_unique<Scene>(std::move(models));
  for (std::size_t i = 0; i < forearms_.size(); ++i) {
    forearms_[i].offset = scene_->items()[models_ + i].offset;
  }
  match_parameters(tracked, render_models);
  match_landmarks(tracked);
}

void Stage::match_parameters(const Scene& tracked, const ConfigNode& render_models) {
  for (std::size_t m = 0; m < models_; ++m) {
    const Scene::Item& drawn = scene_->items()[m];
    const Scene::Item& own = tracked.items()[m];
    const std::vector<std::string> here = parameter_names(*drawn.model);
    const std::vector<std::string> there = parameter_names(*own.model);
    for (const std::string& name : here) {
      parameters_.push_back(own.offset + place_of(there, name));
      if (place_of(there, name) >= 0) continue;
      throw ConfigError(
          fmt::format("{}: this model has the parameter '{}' and the tracked '{}' has "
                      "not; both must have the same parameters to move alike",
                      render_models.get(own.name).where(), name, own.name));
    }
    for (const std::string& name : there) {
      if (place_of(here, name) >= 0) continue;
      throw ConfigError(
          fmt::format("{}: the tracked '{}' has the parameter '{}' and this model has "
                      "not; both must have the same parameters to move alike",
                      render_models.get(own.name).where(), own.name, name));
    }
  }
}

void Stage::match_landmarks(const Scene& tracked) {
  for (const std::string& name : tracked.landmark_names()) {
    landmarks_.push_back(place_of(scene_->landmark_names(), name));
  }
  for (std::size_t m = 0; m < models_; ++m)
    owners_.insert(owners_.end(), tracked.items()[m].model->data().landmarks.size(), m);
}

Eigen::Vector3d Stage::skin() const {
  for (std::size_t m = 0; m < models_; ++m) {
    const Model& model = *scene_->items()[m].model;
    if (const std::optional<int> bone = wrist_bone(model)) return skin_color(model.data(), *bone);
  }
  return 255 * Mesh().color.cast<double>();
}

Eigen::VectorXd Stage::state(const Eigen::VectorXd& tracked, double time) const {
  Eigen::VectorXd state(scene_->dimension());
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    state[static_cast<Eigen::Index>(i)] = tracked[parameters_[i]];
  }
  for (const Forearm& forearm : forearms_) {
    const Scene::Item& hand = scene_->items()[forearm.hand];
    const Eigen::Isometry3d pose = world_from_bones(
        hand.model->data(), scene_->part(hand, state))[static_cast<std::size_t>(forearm.bone)];
    const Eigen::Quaterniond q(pose.linear());
    state.segment<7>(forearm.offset) << pose.translation(), q.w(), q.x(), q.y(), q.z();
  }
  const std::size_t first = models_ + forearms_.size();
  for (std::size_t i = 0; i < cards_.size(); ++i)
    state.segment<7>(scene_->items()[first + i].offset) << cards_[i].middle(time), 1, 0, 0, 0;
  return state;
}

std::vector<bool> Stage::hidden(const std::vector<bool>& absent, int frame) const {
  if (absent.empty() && cards_.empty()) return {};
  std::vector<bool> hidden = absent;
  hidden.resize(models_, false);
  for (const Forearm& forearm : forearms_) hidden.push_back(hidden[forearm.hand]);
  for (const Card& card : cards_) hidden.push_back(!card.is_shown(frame));
  return hidden;
}

Eigen::Matrix3Xd Stage::landmarks(const Eigen::VectorXd& state,
                                  const std::vector<bool>& absent) const {
  if (!others_ && absent.empty()) return {};
  const Eigen::Matrix3Xd drawn = scene_->landmarks(state);
  Eigen::Matrix3Xd landmarks(3, static_cast<Eigen::Index>(landmarks_.size()));
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    auto landmark = landmarks.col(static_cast<Eigen::Index>(i));
    if (landmarks_[i] < 0 || (!absent.empty() && absent[owners_[i]])) {
      landmark.setConstant(std::numeric_limits<double>::quiet_NaN());
    } else {
      landmark = drawn.col(landmarks_[i]);
    }
  }
  return landmarks;
}

cv::Mat Stage::mask(const cv::Mat& label) const {
  cv::Mat mask = label > 0;
  if (!forearms_.empty() || !cards_.empty()) mask.setTo(0, label > static_cast<double>(models_));
  return mask;
}

}  // namespace hypotrack::synthetic
