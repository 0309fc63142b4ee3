#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "base/exported.hpp"
#include "camera/calibration_text.hpp"
#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"

// Parts of cameras that several formats of calibration files share.

namespace hypotrack::calibration {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the value of the first key that exists; undefined if none does.
ConfigNode first_of(const ConfigNode& node, std::initializer_list<std::string_view> names);

/// Returns the value of the first key that exists. Throws DataError with the advice.
ConfigNode required(const ConfigNode& node, std::initializer_list<std::string_view> names,
                    std::string_view advice);

/// Returns the index of a scalar in a list of names. Throws DataError for other words.
template <std::size_t N>
int index_of(const ConfigNode& node, std::string_view key,
             const std::array<std::string_view, N>& names) {
  const auto it = std::find(names.begin(), names.end(), node.scalar());
  if (it == names.end()) {
    throw DataError(fmt::format("{}: {} is '{}'; expected one of {}", node.where(), key,
                                node.scalar().substr(0, 40), fmt::join(names, ", ")));
  }
  return static_cast<int>(it - names.begin());
}

/// Reads image_width and image_height, imageSize or resolution; zeros if there are none.
ImageSize read_size(const ConfigNode& node);

/// Reads a 3x3 camera matrix. Throws DataError on skew.
void read_intrinsics(const ConfigNode& node, Camera& camera);

/// Reads distortion coefficients. An undefined node, or zeros without a model, is a pinhole.
void read_lens(const ConfigNode& node, std::optional<DistortionModel> model, Camera& camera);

/// Sets a camera's pose from a 3x3 rotation and a translation; p_camera = R p_world + T.
void read_pose(const ConfigNode& r, const ConfigNode& t, double metres_per_unit, Camera& camera);

/// Sets a camera's pose after making its rotation orthonormal. Throws DataError, naming `where`, if
/// it is none.
void set_pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation,
              std::string_view where, Camera& camera);

/// Returns a 4x4 rigid transform. Throws DataError if it is none.
Eigen::Isometry3d rigid_transform(const YamlMatrix& matrix, double metres_per_unit);

/// How pictures of a camera are rectified.
struct Rectified {
  Eigen::Matrix3d rectified_from_camera = Eigen::Matrix3d::Identity();
  /// Metres from this to the first camera, in the rectified frame.
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

/// Reads the matrices of a rectification, of which either may be undefined: a rotation, and a
/// projection with fx' Tx and fy' Ty in its last column, for cameras beside and above each other.
Rectified read_rectified(const ConfigNode& rotation, const ConfigNode& projection,
                         double metres_per_unit);

/// Returns the pose of the second camera of a rectified pair; the first is the world.
Eigen::Isometry3d second_from_first(const Rectified& first, const Rectified& second);

/// Returns metres per unit of a file's translations: what the file says under `units`, else the
/// settings, else `usual`; times `scale`.
double metres_per_unit(const ConfigNode& file, const CalibrationSettings& settings,
                       LengthUnit usual = LengthUnit::m);

}  // namespace internal
}  // namespace hypotrack::calibration
