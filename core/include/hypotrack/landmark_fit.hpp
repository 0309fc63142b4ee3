#pragma once

#include <Eigen/Core>
#include <span>

#include "hypotrack/export.hpp"
#include "hypotrack/model.hpp"

namespace hypotrack {

struct LandmarkFitSettings {
  /// Fits the model's size, too: as if everything but its position were `scale` times larger.
  bool scale = false;
  /// Parameters whose angles are near where none is determined, a pose shortly before for example;
  /// empty: the model's rest.
  std::span<const double> prior{};
  int iterations = 100;
};

/// A pose that brings a model's landmarks onto given ones.
struct LandmarkFit {
  Eigen::VectorXd parameters;  ///< of the model, within its bounds; quaternion of unit length
  double scale = 1;
  double mean_distance = 0;  ///< metres, over the landmarks that are known
  double max_distance = 0;
};

/// Damped least squares (Levenberg-Marquardt) over the known columns of `landmarks` (3xL, world,
/// metres; a column with a NaN is unknown) from `start`, which may be some centimetres and tens of
/// degrees off; angles are kept within their bounds. Beside the mean squared distance a radian away
/// from the prior costs as much as 0.5 mm, so that angles that no landmark determines stay near it.
/// Deterministic. Throws DataError if fewer than three landmarks are known or the number of columns
/// is not the model's number of landmarks.
HYPOTRACK_API LandmarkFit fit_landmarks(const Model& model, const Eigen::Matrix3Xd& landmarks,
                                        std::span<const double> start,
                                        const LandmarkFitSettings& settings = {});

/// `start` moved and turned as one rigid body so that its landmarks come nearest to the known ones
/// (Umeyama, "Least-squares estimation of transformation parameters between two point patterns",
/// 1991): a start for fit_landmarks where none is known. Throws where it does.
HYPOTRACK_API Eigen::VectorXd align_to_landmarks(const Model& model,
                                                 const Eigen::Matrix3Xd& landmarks,
                                                 std::span<const double> start);

}  // namespace hypotrack
