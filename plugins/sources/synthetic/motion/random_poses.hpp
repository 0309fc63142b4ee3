#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/scene.hpp"
#include "motion/gestures.hpp"
#include "motion/random_motion.hpp"

namespace hypotrack::synthetic {

/// Returns the rotation of a model in a state.
Eigen::Quaterniond rotation_of(const Scene::Item& item, const Eigen::VectorXd& state);

/// Draws states of a scene that all cameras see completely.
class RandomPoses {
 public:
  /// A model that another one holds.
  struct Held {
    std::size_t model = 0, holder = 0;
    Eigen::Isometry3d holder_from_model;
  };

  /// All arguments must outlive the object. Throws ConfigError with file:line:column.
  RandomPoses(const RandomParams& params, const ConfigNode& node, const Gestures& gestures,
              const Scene& scene, const std::vector<Camera>& cameras);

  /// Draws a good state. Every model with joints gets another gesture than in the last state, if
  /// there are two. Throws ConfigError if none is found.
  Eigen::VectorXd draw();
  /// Returns whether all models lie in all pictures and those not held keep their distance.
  bool is_good(const Eigen::VectorXd& state) const;
  /// Throws the ConfigError of a box without good states.
  [[noreturn]] void fail() const;

  const std::vector<Held>& held() const { return held_; }
  bool is_held(std::size_t model) const;
  cv::RNG& random() { return random_; }

 private:
  void read_gestures(const Gestures& gestures);
  void read_holds();
  void place(std::size_t model, Eigen::VectorXd& state);
  void place_held(Eigen::VectorXd& state) const;
  Eigen::Quaterniond draw_rotation();
  bool is_seen(const Scene::Item& item, const Eigen::VectorXd& state) const;
  bool keep_apart(const Eigen::VectorXd& state) const;

  const RandomParams& params_;
  const ConfigNode& node_;
  const Scene& scene_;
  const std::vector<Camera>& cameras_;
  std::vector<std::vector<std::vector<double>>> gestures_;  // by model: parameters of each gesture
  std::vector<std::size_t> last_;                           // by model: the gesture drawn last
  std::vector<Held> held_;
  cv::RNG random_;
};

}  // namespace hypotrack::synthetic
