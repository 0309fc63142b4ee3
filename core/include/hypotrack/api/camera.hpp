#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <string_view>
#include <vector>

#include "hypotrack/api/export.hpp"

namespace hypotrack {

/// Lens distortion model, with OpenCV's equations and coefficient order.
enum class DistortionModel {
  none,     ///< pinhole
  brown,    ///< k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]]: 4, 5, 8, 12 or 14
  fisheye,  ///< k1 k2 k3 k4: cv::fisheye
};

/// A calibrated camera with OpenCV's axes: x right, y down, z forward. Lengths are metres. Pixel
/// centres are at integers: the top-left pixel covers [-0.5, 0.5] x [-0.5, 0.5].
struct Camera {
  int width = 0;
  int height = 0;
  double fx = 0;
  double fy = 0;
  double cx = 0;
  double cy = 0;
  DistortionModel distortion_model = DistortionModel::none;
  std::vector<double> distortion = {};
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
};

/// Projects a world point to a pixel, lens distortion included. Returns NaN for points at or behind
/// the camera.
HYPOTRACK_API Eigen::Vector2d project(const Camera& camera, const Eigen::Vector3d& p_world);

/// Throws DataError, naming `where`, if a camera is invalid. Sizes and focal lengths must be
/// positive, all numbers finite, and the number of coefficients must fit the model. The rotation
/// must be orthonormal with determinant +1, within 1e-4.
HYPOTRACK_API void validate(const Camera& camera, std::string_view where);

/// Computes the rays of pixels (2xN), lens distortion removed: points (3xN) of depth 1 in the
/// camera's frame. NaN where the lens model cannot be inverted.
HYPOTRACK_API Eigen::Matrix3Xd back_project(const Camera& camera, const Eigen::Matrix2Xd& pixels);

}  // namespace hypotrack
