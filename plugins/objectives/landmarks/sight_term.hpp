#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::landmarks {

/// A camera's line of sight that should pass through a landmark.
struct Sight {
  Eigen::Index landmark = 0;                      ///< of the model
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< the camera's place in the world
  Eigen::Vector3d along = Eigen::Vector3d::UnitZ();
  double distance = 0;  ///< metres from the eye at which deviations are measured
  double factor = 0;    ///< root of the weight; 0: nothing was seen
};

/// The lines of sight of one model's landmarks.
struct HandSights {
  const Model* model = nullptr;
  int offset = 0;  ///< of the model's parameters in the state
  std::vector<Sight> sights = {};
};

/// How far from its line of sight a landmark costs nothing, and on what scale it costs beyond.
struct Deviation {
  double free;   ///< metres, >= 0
  double sigma;  ///< metres, > 0
};

/// Returns the number of residuals: two per line of sight.
std::int64_t residual_count(std::span<const HandSights> hands);

/// Returns the cost of a normalised state and writes its residuals, unless `residuals` is empty.
/// The cost is their sum of squares.
double cost_and_residuals(std::span<const HandSights> hands, const Deviation& deviation,
                          std::span<const double> state, std::span<float> residuals);

/// Writes the derivatives of all residuals by a normalised state into a Jacobian of zeros. No model
/// poses itself.
void write_jacobian(std::span<const HandSights> hands, const Deviation& deviation,
                    std::span<const double> state, Jacobian& jacobian);

}  // namespace hypotrack::landmarks
