#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "forearm.hpp"
#include "hypotrack/plugin.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack::synthetic {

/// What stands before the cameras: the tracked models or others in their place, and forearms.
class Stage {
 public:
  /// `render_models` maps names of tracked models to the plugins that are drawn instead; it may be
  /// undefined. Throws ConfigError on names that the scene does not have, on models whose
  /// parameters are not those of the tracked one, and on a forearm for a scene without a hand.
  Stage(const Scene& tracked, const ConfigNode& render_models, const ForearmParams& forearm,
        PluginContext& context);

  /// What is drawn: as many models as are tracked, in their order, then the forearms.
  const Scene& scene() const { return *scene_; }

  /// State of scene() for a state of the tracked scene: parameters of one name have one value.
  Eigen::VectorXd state(const Eigen::VectorXd& tracked) const;

  /// For each model of scene() whether it is not drawn where models of the tracked scene are absent
  /// (empty: none): these and their forearms. Empty if all are drawn.
  std::vector<bool> hidden(const std::vector<bool>& absent) const;

  /// Where the landmarks of the tracked scene lie on what is drawn, for a state of scene(): 3xL,
  /// metres, NaN where a model is absent (empty: none) or the drawn one has no landmark of that
  /// name. 3x0 if all that is drawn is tracked and nothing is absent: the tracked state then says
  /// it.
  Eigen::Matrix3Xd landmarks(const Eigen::VectorXd& state, const std::vector<bool>& absent) const;

  /// Foreground (8-bit, 255 where a tracked model or what stands for it is what one sees) from the
  /// renderer's labels. A forearm is background and covers what is behind it.
  cv::Mat mask(const cv::Mat& label) const;

 private:
  struct Forearm {
    std::size_t hand = 0;  // among the models
    int bone = 0;          // that carries it
    int offset = 0;        // of its pose in the state
  };
  void match_parameters(const Scene& tracked, const ConfigNode& render_models);
  void match_landmarks(const Scene& tracked);

  std::size_t models_ = 0;
  bool others_ = false;  // some model is not the tracked one
  std::unique_ptr<const Scene> scene_;
  std::vector<int> parameters_;      // of scene(), forearms excluded: index in the tracked state
  std::vector<int> landmarks_;       // of the tracked scene: index in scene(), -1: there is none
  std::vector<std::size_t> owners_;  // of these landmarks: their models
  std::vector<Forearm> forearms_;
};

}  // namespace hypotrack::synthetic
