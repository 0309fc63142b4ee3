#pragma once

#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/calibration.hpp"
#include "hypotrack/config.hpp"

// Readers of calibration files, one for each format. They return cameras in the order of the file,
// without widths and heights where it gives none. They throw DataError, naming file, line and key.
// `notes` receives lines for the user, such as what of a file was not understood.

namespace hypotrack::calibration {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads hypotrack's own form: `cameras`, a list.
std::vector<NamedCamera> read_camera_list(const ConfigNode& file,
                                          const CalibrationSettings& settings);

/// Reads what OpenCV's stereo_calib writes; R and T may be in a file of their own.
std::vector<NamedCamera> read_opencv_stereo(const ConfigNode& file,
                                            const CalibrationSettings& settings);

/// Reads what OpenCV's calibration program writes: one camera, or one of two files for a camera
/// each, with R and T in a third.
std::vector<NamedCamera> read_opencv_single(const ConfigNode& file,
                                            const CalibrationSettings& settings);

/// Returns whether a file is a camera_info of ROS: a file of camera_calibration, or a message.
bool is_ros(const ConfigNode& file);

/// Reads a camera_info of ROS, or those of a pair, whose projection matrices give the baseline.
std::vector<NamedCamera> read_ros(const ConfigNode& file, const CalibrationSettings& settings,
                                  std::vector<std::string>& notes);

/// Reads a camchain of Kalibr. Poses come from T_cn_cnm1, or else from T_cam_imu or T_imu_cam of
/// each camera.
std::vector<NamedCamera> read_kalibr(const ConfigNode& file, const CalibrationSettings& settings);

/// Returns whether a file is a ZED's factory calibration.
bool is_zed(const ConfigNode& file);

/// Reads a ZED's factory calibration for pictures of one size.
std::vector<NamedCamera> read_zed(const ConfigNode& file, const CalibrationSettings& settings,
                                  const ImageSize& pictures, std::vector<std::string>& notes);

/// Reads the TOML of caliscope or anipose: a table for each camera. Returns none for other files.
std::vector<NamedCamera> read_camera_tables(const ConfigNode& file,
                                            const CalibrationSettings& settings);

}  // namespace internal
}  // namespace hypotrack::calibration
