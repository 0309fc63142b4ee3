#pragma once

#include <Eigen/Core>
#include <span>

#include "hypotrack/api/export.hpp"
#include "hypotrack/plugin/model.hpp"

namespace hypotrack {

/// Settings of fit_landmarks().
struct LandmarkFitSettings {
  /// Fits the model's scale as well, about its position.
  bool scale = false;
  /// Parameter vector whose angles are the prior, for example a recent pose. Empty: the model's
  /// rest.
  std::span<const double> prior{};
  int iterations = 100;
};

/// A fitted pose and its distances from the given landmarks.
struct LandmarkFit {
  Eigen::VectorXd parameters;  ///< within the model's bounds; unit quaternion
  double scale = 1;
  double mean_distance = 0;  ///< metres, over the known landmarks
  double max_distance = 0;
};

/// Fits a model's parameters to landmark positions by damped least squares (Levenberg-Marquardt).
/// `landmarks` is 3xL, world, metres; a column with a NaN is unknown. `start` may be some
/// centimetres and tens of degrees off. Angles stay within their bounds.
/// The cost is the mean squared distance plus a prior: an angle one radian from the prior costs as
/// much as 0.5 mm. Angles that no landmark determines so stay near it. Deterministic.
/// Throws DataError if fewer than three landmarks are known or `landmarks` has another number of
/// columns than the model has landmarks.
HYPOTRACK_API LandmarkFit fit_landmarks(const Model& model, const Eigen::Matrix3Xd& landmarks,
                                        std::span<const double> start,
                                        const LandmarkFitSettings& settings = {});

/// Moves and turns the model of `start` rigidly so that its landmarks fit the known ones best. Use
/// it as a start for fit_landmarks() if no better one is known. Throws as fit_landmarks() does.
/// Source: Umeyama, "Least-squares estimation of transformation parameters between two point
/// patterns", 1991.
HYPOTRACK_API Eigen::VectorXd align_to_landmarks(const Model& model,
                                                 const Eigen::Matrix3Xd& landmarks,
                                                 std::span<const double> start);

}  // namespace hypotrack
