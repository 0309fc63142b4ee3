#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/camera.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"
#include "tile/color_map.hpp"
#include "track/model_pose.hpp"
#include "track/verify/appearance.hpp"
#include "track/verify/evidence.hpp"
#include "track/verify/foreground_colors.hpp"
#include "track/verify/surface_samples.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Estimates from the pictures alone whether the pose of one model is right.
class ModelVerifier {
 public:
  /// The scene must outlive the verifier.
  ModelVerifier(const Scene& scene, std::size_t model, const std::vector<Camera>& cameras);

  /// Measures how well a frame supports the model's pose in `state`. `colors` maps the second
  /// view's colours to the first's.
  Evidence measure_evidence(const Frame& frame, const Eigen::VectorXd& state,
                            const ColorMap& colors);

  /// Returns a state with the model turned to where its texture fits best, of all poses with the
  /// same silhouette. Models that are not rigid, without texture or without symmetries stay.
  Eigen::VectorXd turned_to_texture(const Frame& frame, const Eigen::VectorXd& state,
                                    const ColorMap& colors);

  /// Returns the classifier's features: the evidence and, after learn(), its differences from the
  /// usual evidence (zeros before).
  Eigen::VectorXd features(const Evidence& evidence) const;

  /// Returns the log odds that the model's landmarks are about where they were found (weights.hpp).
  /// -infinity without evidence.
  double log_odds(const Evidence& evidence) const;

  /// Sets what hides the model in the frames measured from now on; null: nothing.
  void hide(std::shared_ptr<const HiddenViews> hidden) { sampler_.hide(std::move(hidden)); }

  /// Sets whether the model was tracked in the last frame. Its likeness then counts half, because a
  /// hand that turns or closes shows sides that were not seen before.
  void set_tracked(bool tracked) { tracked_ = tracked; }

  /// Learns colours and usual evidence from the last measure_evidence(), in which the model was
  /// surely right.
  void learn(const Evidence& evidence);
  /// Forgets what was learned.
  void forget();
  bool experienced() const { return usual_.has_value(); }
  const ForegroundColors& colors() const { return colors_; }
  /// Returns the mean evidence of frames in which the model was surely right; 0 before learn().
  double usual(Evidence::Index i) const { return usual_ ? (*usual_)[i] : 0; }
  double usual_likeness() const { return usual_likeness_; }

 private:
  const Scene::Item& item_;
  SurfaceSampler sampler_;
  SurfaceSamples samples_;
  ForegroundColors colors_;
  Appearance texture_;                         ///< of a rigid model; knows nothing of others
  std::vector<Eigen::Isometry3d> symmetries_;  ///< of a rigid model with a texture
  Appearance appearance_;
  double usual_likeness_ = 0;
  bool tracked_ = false;
  std::optional<std::array<double, Evidence::kCount>> usual_;
};

/// Probability, by model, that its pose is right. NaN: unknown, for example where others hide it.
using ModelProbabilities = std::vector<double>;

/// Estimates for every model of a scene whether its pose is right.
class PoseVerifier {
 public:
  /// The scene must outlive the verifier.
  PoseVerifier(const Scene& scene, const std::vector<Camera>& cameras);

  /// Verifies the flagged models (one flag each) in a frame with the scene posed in a normalised
  /// state. The others get NaN, and so do all in frames without colours in two views.
  ModelProbabilities verify(const Frame& frame, const Eigen::VectorXd& state,
                            const ColorMap& colors, const std::vector<bool>& models);

  /// Sets what hides models in the frames verified from now on; null: nothing.
  void hide(const std::shared_ptr<const HiddenViews>& hidden) {
    for (ModelVerifier& model : models_) model.hide(hidden);
  }
  /// Returns the colours of a model.
  const ForegroundColors& colors(std::size_t model) const { return models_.at(model).colors(); }

  /// Sets whether a model was tracked in the last frame (ModelVerifier::set_tracked()).
  void set_tracked(std::size_t model, bool tracked) {
    if (model < models_.size()) models_[model].set_tracked(tracked);
  }

  /// Learns from the last frame verified. `right` flags the models whose pose was surely right.
  void learn(const std::vector<bool>& right);

  /// Forgets what was learned of a model.
  void forget(std::size_t model) { models_.at(model).forget(); }

  /// Returns whether the last call of verify() was for this state.
  bool verified(const Eigen::VectorXd& state) const {
    return state_.size() == state.size() && state_ == state;
  }
  /// Returns whether a model was surely right at least once.
  bool experienced(std::size_t model) const {
    return model < models_.size() && models_[model].experienced();
  }
  bool experienced() const;
  /// Returns the verifier of one model. Its measure_evidence() invalidates learn() until the next
  /// verify().
  ModelVerifier& model(std::size_t i) {
    state_.resize(0);
    return models_[i];
  }

 private:
  std::vector<ModelVerifier> models_;
  std::vector<Evidence> evidence_;
  Eigen::VectorXd state_;
};

}  // namespace internal
}  // namespace hypotrack
