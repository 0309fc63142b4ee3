#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "stage/cards.hpp"
#include "stage/forearm.hpp"

namespace hypotrack::synthetic {

/// The models that are rendered: the tracked ones or replacements, forearms and cards.
class Stage {
 public:
  /// `render_models` maps names of tracked models to the plugins that replace them; it may be
  /// undefined. Throws ConfigError on names that the scene does not have, on models whose
  /// parameters differ from those of the tracked one, and on a forearm for a scene without a hand.
  Stage(const Scene& tracked, const ConfigNode& render_models, const ForearmParams& forearm,
        std::vector<Card> cards, PluginContext& context);

  /// Returns the rendered scene: a model for each tracked one, in their order, then the forearms,
  /// then the cards.
  const Scene& scene() const { return *scene_; }

  /// Returns the colour of the first hand's skin (red, green, blue, up to 255), a usual one if
  /// there is no hand.
  Eigen::Vector3d skin() const;

  /// Returns the state of scene() for a state of the tracked scene at a time in seconds.
  /// Parameters with the same name have the same value.
  Eigen::VectorXd state(const Eigen::VectorXd& tracked, double time) const;

  /// Returns for each model of scene() whether a frame does not show it: its tracked model is
  /// absent, forearms included, or the card comes at another time. `absent` has a flag per tracked
  /// model (empty: none). Empty if all are drawn.
  std::vector<bool> hidden(const std::vector<bool>& absent, int frame) const;

  /// Returns the tracked scene's landmarks on the rendered models, for a state of scene(): 3xL,
  /// metres. NaN where a model is absent (`absent` empty: none) or the rendered one has no landmark
  /// of that name. 3x0 if the rendered models are the tracked ones and none is absent: the tracked
  /// state then gives them.
  Eigen::Matrix3Xd landmarks(const Eigen::VectorXd& state, const std::vector<bool>& absent) const;

  /// Returns the foreground mask from the renderer's labels: 8-bit, 255 where a tracked model or
  /// its replacement is visible. Forearms and cards are background and hide what is behind them.
  cv::Mat mask(const cv::Mat& label) const;

 private:
  struct Forearm {
    std::size_t hand = 0;  // index among the models
    int bone = 0;          // bone that carries it
    int offset = 0;        // of its pose in the state
  };
  void match_parameters(const Scene& tracked, const ConfigNode& render_models);
  void match_landmarks(const Scene& tracked);

  std::size_t models_ = 0;
  bool others_ = false;  // some model is a replacement
  std::unique_ptr<const Scene> scene_;
  std::vector<int>
      parameters_;  // of scene(), without forearms and cards: index in the tracked state
  std::vector<int> landmarks_;       // of the tracked scene: index in scene(), -1: none
  std::vector<std::size_t> owners_;  // models of these landmarks
  std::vector<Forearm> forearms_;
  std::vector<Card> cards_;
};

}  // namespace hypotrack::synthetic
