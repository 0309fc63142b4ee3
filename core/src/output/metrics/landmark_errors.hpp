#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Assignment of landmarks to models.
struct LandmarkLayout {
  std::vector<std::string> names;     ///< L of them, `model.landmark`
  std::vector<std::string> models;    ///< in the order of their first landmarks
  std::vector<std::size_t> model_of;  ///< L indices into `models`
};

/// Assigns landmarks to models by the part of the name before the first dot. Names without a dot
/// belong to a model called `model`.
LandmarkLayout landmark_layout(std::span<const std::string> names);

/// Returns for each model the mean of its landmarks' `values` (L numbers). NaN values are left out.
/// A model with no other values gets NaN.
std::vector<double> model_means(const LandmarkLayout& layout, const Eigen::VectorXd& values);

/// Error of an estimate in one frame, in the unit of the landmarks.
struct FrameError {
  Eigen::VectorXd landmarks;   ///< L distances between estimate and truth; NaN: unknown
  std::vector<double> models;  ///< mean over a model's landmarks, NaN if it has none
  double mean = 0;             ///< over the models; NaN if none has an error
};

/// Computes the paper's error of a frame. It averages distances over the landmarks of a model
/// (joints, or three anchors of a rigid object), then over the objects. Both matrices are 3xL; an
/// empty `truth` is unknown.
FrameError frame_error(const LandmarkLayout& layout, const Eigen::Matrix3Xd& estimate,
                       const Eigen::Matrix3Xd& truth);

}  // namespace internal
}  // namespace hypotrack
