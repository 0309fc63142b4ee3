#pragma once

#include <functional>
#include <memory>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::stereo_color {

/// Palm to the cameras, fingers up, everything bent a little.
Eigen::VectorXd slightly_bent(const Scene& scene);

/// A textured hand before noise as a rectified pair of tiles sees it, drawn with OpenGL, and
/// costs of hypotheses of it.
class RenderedPair {
 public:
  using Pose = std::function<Eigen::VectorXd(const Scene&)>;

  /// Throws DeviceError where there is no OpenGL.
  explicit RenderedPair(const Pose& pose = slightly_bent);

  const Observation& observation() const { return observation_; }
  const Scene& scene() const { return *scene_; }
  const Eigen::VectorXd& truth() const { return truth_; }
  /// Costs of states, one per column.
  Eigen::VectorXd costs(const std::shared_ptr<Objective>& objective,
                        const Eigen::MatrixXd& states) const;

 private:
  std::unique_ptr<Scene> scene_;
  Eigen::VectorXd truth_;
  Observation observation_;
};

}  // namespace hypotrack::stereo_color
