#pragma once

#include <Eigen/Core>

#include "hypotrack/plugin.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack::test {

/// A pose and one scale that bring a model's landmarks onto given ones.
struct LandmarkFit {
  Eigen::VectorXd state;  ///< of the scene, to be used with the model made `scale` times larger
  double scale = 1;
  double mean_distance = 0;  ///< metres, over the landmarks that are known
};

/// Least squares over the known columns of `truth` (3xL, metres; NaN: unknown), within the bounds
/// of the scene's only model. Angles that the landmarks do not determine stay near their rest.
/// Searches from `start`, which may be some centimetres and tens of degrees off, with the nlopt
/// plugin.
LandmarkFit fit_landmarks(const Scene& scene, const Eigen::Matrix3Xd& truth,
                          const Eigen::VectorXd& start, double start_scale, PluginLoader& plugins);

}  // namespace hypotrack::test
