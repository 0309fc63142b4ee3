#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/judge.hpp"
#include "tile/color_map.hpp"
#include "track/model_pose.hpp"
#include "track/side_work.hpp"
#include "track/verify/appearance.hpp"
#include "track/verify/foreground_colors.hpp"
#include "track/verify/surface_samples.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Measures how well samples of a model support its pose: `values`, `likeness`, `covered`, `points`
/// and `known`. `colors` gives the foreground probabilities, 0.5 before anything was learned.
Measures measure(const SurfaceSamples& samples, const ForegroundColors& colors,
                 const Appearance& appearance);

/// Measures how well the pictures support poses of one model, and learns what is usual.
class ModelVerifier {
 public:
  /// The scene must outlive the verifier.
  ModelVerifier(const Scene& scene, std::size_t model, const std::vector<Camera>& cameras);

  /// Measures how well a frame supports the model's pose in `state`. `colors` maps the second
  /// view's colours to the first's.
  Measures measured(const Frame& frame, const Eigen::VectorXd& state, const ColorMap& colors);

  /// Returns a state with the model turned to where its texture fits best, of all poses with the
  /// same silhouette. Models that are not rigid, without texture or without symmetries stay.
  Eigen::VectorXd turned_to_texture(const Frame& frame, const Eigen::VectorXd& state,
                                    const ColorMap& colors);

  /// Sets what hides the model in the frames measured from now on; null: nothing.
  void hide(std::shared_ptr<const HiddenViews> hidden) { sampler_.hide(std::move(hidden)); }

  /// Sets whether the model was tracked in the last frame (Measures::tracked).
  void set_tracked(bool tracked) { tracked_ = tracked; }

  /// Learns looks and usual measures from the last measured(), in which the model was surely right.
  void learn(const Measures& measures) {
    if (learn_usual(measures)) learn_looks();
  }
  /// Does the part of learn() that tells what is usual, and all of it at first. Returns whether
  /// learn_looks() is left to be called before measured().
  bool learn_usual(const Measures& measures);
  void learn_looks();
  /// Forgets what was learned.
  void forget();
  bool experienced() const { return usual_.has_value(); }
  const ForegroundColors& colors() const { return colors_; }
  /// Returns the mean of a measure over frames in which the model was surely right; 0 before
  /// learn().
  double usual(Measures::Index i) const { return usual_ ? (*usual_)[i] : 0; }

 private:
  const Scene::Item& item_;
  std::size_t model_;
  SurfaceSampler sampler_;
  SurfaceSamples samples_;
  ForegroundColors colors_;
  Appearance texture_;                         ///< of a rigid model; knows nothing of others
  std::vector<Eigen::Isometry3d> symmetries_;  ///< of a rigid model with a texture
  Appearance appearance_;
  double usual_likeness_ = 0;
  bool tracked_ = false;
  std::optional<std::array<double, Measures::kCount>> usual_;
};

/// Probability, by model, that its pose is right. NaN: unknown, for example where others hide it.
using ModelProbabilities = std::vector<double>;

/// Estimates for every model of a scene whether its pose is right: measures it and asks the judge.
class PoseVerifier {
 public:
  /// The scene must outlive the verifier. `judge` may be null if nothing is to be verified.
  PoseVerifier(const Scene& scene, const std::vector<Camera>& cameras,
               std::shared_ptr<const Judge> judge);

  /// Verifies the flagged models (one flag each) in a frame with the scene posed in a normalised
  /// state. The others get NaN, and so do all in frames without colours in two views.
  ModelProbabilities verify(const Frame& frame, const Eigen::VectorXd& state,
                            const ColorMap& colors, const std::vector<bool>& models);

  /// Returns the log odds that a pose is right, by its measures; -infinity if nothing is known.
  double log_odds(const Measures& measures) const;

  /// Sets what hides models in the frames verified from now on; null: nothing.
  void hide(const std::shared_ptr<const HiddenViews>& hidden) {
    for (ModelVerifier& model : models_) model.hide(hidden);
  }
  /// Returns the colours of a model.
  const ForegroundColors& colors(std::size_t model) const {
    looks_.wait();
    return models_.at(model).colors();
  }

  /// Sets whether a model was tracked in the last frame (ModelVerifier::set_tracked()).
  void set_tracked(std::size_t model, bool tracked) {
    if (model < models_.size()) models_[model].set_tracked(tracked);
  }

  /// Learns from the last frame verified. `right` flags the models whose pose was surely right.
  /// Looks are learned beside what the caller does next; errors are thrown where they are used.
  void learn(const std::vector<bool>& right);

  /// Forgets what was learned of a model.
  void forget(std::size_t model) {
    looks_.wait();
    models_.at(model).forget();
  }

  /// Returns whether the last call of verify() was for this state.
  bool verified(const Eigen::VectorXd& state) const {
    return state_.size() == state.size() && state_ == state;
  }
  /// Returns whether a model was surely right at least once.
  bool experienced(std::size_t model) const {
    return model < models_.size() && models_[model].experienced();
  }
  bool experienced() const;
  /// Returns the verifier of one model. Its measured() invalidates learn() until the next verify().
  ModelVerifier& model(std::size_t i) {
    looks_.wait();
    state_.resize(0);
    return models_[i];
  }

 private:
  std::shared_ptr<const Judge> judge_;
  std::vector<ModelVerifier> models_;
  std::vector<Measures> measures_;  ///< by model, of the last verify()
  Eigen::VectorXd state_;
  mutable SideWork looks_{"learn looks"};  ///< of models_
};

}  // namespace internal
}  // namespace hypotrack
