#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

/// Which landmark belongs to which model.
struct LandmarkLayout {
  std::vector<std::string> names;     ///< L of them, `model.landmark`
  std::vector<std::string> models;    ///< in the order of their first landmarks
  std::vector<std::size_t> model_of;  ///< L indices into `models`
};

/// What stands before the first dot of a name is its model; names without one belong to a model
/// called `model`.
HYPOTRACK_API LandmarkLayout landmark_layout(std::span<const std::string> names);

/// For each model the mean of what its landmarks have (`values`, L numbers); NaN entries are left
/// out, and a model that has no others is NaN.
HYPOTRACK_API std::vector<double> model_means(const LandmarkLayout& layout,
                                              const Eigen::VectorXd& values);

/// How far an estimate is off in one frame, in the unit of the landmarks.
struct FrameError {
  Eigen::VectorXd landmarks;   ///< L distances between estimate and truth; NaN: one is unknown
  std::vector<double> models;  ///< mean over a model's landmarks, NaN if it has none
  double mean = 0;             ///< over the models; NaN if none has an error
};

/// The paper's error of a frame: distances averaged over the joints of a hand or the
/// three anchors of a rigid object, then over the objects. Both matrices are 3xL; an empty `truth`
/// is an unknown one.
HYPOTRACK_API FrameError frame_error(const LandmarkLayout& layout, const Eigen::Matrix3Xd& estimate,
                                     const Eigen::Matrix3Xd& truth);

}  // namespace hypotrack
