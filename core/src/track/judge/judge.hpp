#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/scene.hpp"
#include "tile/color_map.hpp"
#include "track/judge/appearance.hpp"
#include "track/judge/evidence.hpp"
#include "track/judge/foreground_colors.hpp"
#include "track/judge/surface_samples.hpp"

namespace hypotrack {

/// Judges from the pictures alone whether one model is where it was found.
class HYPOTRACK_API ModelJudge {
 public:
  /// The scene must outlive the judge.
  ModelJudge(const Scene& scene, std::size_t model, const std::vector<Camera>& cameras);

  /// Measures a frame with the scene posed in `state`. `colors` makes the second view's colours the
  /// first's.
  Evidence look(const Frame& frame, const Eigen::VectorXd& state, const ColorMap& colors);

  /// Evidence and, after learn(), its differences to what is usual: what classifiers see.
  Eigen::VectorXd features(const Evidence& evidence) const;

  /// Logarithm of the odds that the model's landmarks are about where they were found
  /// (weights.hpp).
  double log_odds(const Evidence& evidence) const;

  /// Sets whether the model was tracked in the last frame. Its likeness counts half then: a hand
  /// that turns or closes shows sides unlike those seen before.
  void set_tracked(bool tracked) { tracked_ = tracked; }

  /// Learns colours and usual evidence from the last look, at which the model was surely right.
  void learn(const Evidence& evidence);
  bool experienced() const { return usual_.has_value(); }
  const ForegroundColors& colors() const { return colors_; }
  /// What is usual where the model is surely right; 0 before learn().
  double usual(Evidence::Index i) const { return usual_ ? (*usual_)[i] : 0; }
  double usual_likeness() const { return usual_likeness_; }

 private:
  SurfaceSampler sampler_;
  SurfaceSamples samples_;
  ForegroundColors colors_;
  Appearance appearance_;
  double usual_likeness_ = 0;
  bool tracked_ = false;
  std::optional<std::array<double, Evidence::kCount>> usual_;
};

/// Probability that each model is right; NaN: nothing is known, as of one that others hide.
using Verdict = std::vector<double>;

/// Judges all models of a scene.
class HYPOTRACK_API Judge {
 public:
  /// The scene must outlive the judge.
  Judge(const Scene& scene, const std::vector<Camera>& cameras);

  /// Judges some models (one flag each) in a frame with the scene posed in a normalised state.
  /// Nothing is known of the others, and of any without colours in two views.
  Verdict judge(const Frame& frame, const Eigen::VectorXd& state, const ColorMap& colors,
                const std::vector<bool>& models);

  /// Sets whether a model was tracked in the last frame (ModelJudge::set_tracked()).
  void set_tracked(std::size_t model, bool tracked) {
    if (model < models_.size()) models_[model].set_tracked(tracked);
  }

  /// Learns from the last frame judged. The models of which `right` is set were surely right.
  void learn(const std::vector<bool>& right);

  /// Whether a state was judged last.
  bool judged(const Eigen::VectorXd& state) const {
    return state_.size() == state.size() && state_ == state;
  }
  /// Whether a model, or any, was surely right once.
  bool experienced(std::size_t model) const {
    return model < models_.size() && models_[model].experienced();
  }
  bool experienced() const;
  /// The judge of one model. A look of its own makes learn() wrong until the next judge().
  ModelJudge& model(std::size_t i) {
    state_.resize(0);
    return models_[i];
  }

 private:
  std::vector<ModelJudge> models_;
  std::vector<Evidence> evidence_;
  Eigen::VectorXd state_;
};

}  // namespace hypotrack
