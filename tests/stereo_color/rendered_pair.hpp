#pragma once

#include <memory>

#include "hypotrack/objective.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack::stereo_color {

/// A textured hand before noise as a rectified pair of tiles sees it, drawn with OpenGL, and
/// costs of hypotheses of it.
class RenderedPair {
 public:
  /// Throws DeviceError where there is no OpenGL.
  RenderedPair();

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
