#pragma once

#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/calibration.hpp"
#include "hypotrack/api/config.hpp"

// Readers of calibration files, one for each format. They return cameras in the order of the file,
// without widths and heights where it gives none. They throw DataError, naming file, line and key.
// `notes` receives lines for the user, such as what of a file was not understood.

namespace hypotrack::calibration {
inline namespace HYPOTRACK_EXPORTED internal {

/// Reads hypotrack's own form: `cameras`, a list.
std::vector<NamedCamera> read_camera_list(const ConfigNode& file,
                                          const CalibrationSettings& settings,
                                          std::vector<std::string>& notes);

/// Reads what OpenCV's stereo_calib writes; R and T may be in a file of their own.
std::vector<NamedCamera> read_opencv_stereo(const ConfigNode& file,
                                            const CalibrationSettings& settings,
                                            std::vector<std::string>& notes);

/// Reads what OpenCV's calibration program writes: one camera, or one of two files for a camera
/// each, with R and T in a third.
std::vector<NamedCamera> read_opencv_single(const ConfigNode& file,
                                            const CalibrationSettings& settings,
                                            std::vector<std::string>& notes);

/// Returns whether a file is a camera_info of ROS: a file of camera_calibration, or a message.
bool is_ros(const ConfigNode& file);

/// Reads a camera_info of ROS, or those of a pair, whose projection matrices give the baseline.
std::vector<NamedCamera> read_ros(const ConfigNode& file, const CalibrationSettings& settings,
                                  std::vector<std::string>& notes);

/// Reads a camchain of Kalibr. Poses come from T_cn_cnm1, or else from T_cam_imu or T_imu_cam of
/// each camera.
std::vector<NamedCamera> read_kalibr(const ConfigNode& file, const CalibrationSettings& settings,
                                     std::vector<std::string>& notes);

/// Returns whether a file is a ZED's factory calibration.
bool is_zed(const ConfigNode& file);

/// Reads a ZED's factory calibration for pictures of one size.
std::vector<NamedCamera> read_zed(const ConfigNode& file, const CalibrationSettings& settings,
                                  const ImageSize& pictures, std::vector<std::string>& notes);

/// Returns whether a file is what depthai exports of the memory of an OAK camera.
bool is_depthai(const ConfigNode& file);

/// Reads a calibration of depthai: the stereo pair, or the cameras that the settings name.
std::vector<NamedCamera> read_depthai(const ConfigNode& file, const CalibrationSettings& settings,
                                      std::vector<std::string>& notes);

/// Returns whether a file is a sensor.yaml of a camera, as the EuRoC recordings have it.
bool is_euroc(const ConfigNode& file);

/// Reads a sensor.yaml, or those of a pair, whose T_BS give the poses.
std::vector<NamedCamera> read_euroc(const ConfigNode& file, const CalibrationSettings& settings,
                                    std::vector<std::string>& notes);

/// Returns whether a file has settings of ORB-SLAM 2 or 3.
bool is_orb_slam(const ConfigNode& file);

/// Reads the cameras of ORB-SLAM's settings: one, or a pair.
std::vector<NamedCamera> read_orb_slam(const ConfigNode& file, const CalibrationSettings& settings,
                                       std::vector<std::string>& notes);

/// Reads the TOML of caliscope or anipose: a table for each camera. Returns none for other files.
std::vector<NamedCamera> read_camera_tables(const ConfigNode& file,
                                            const CalibrationSettings& settings,
                                            std::vector<std::string>& notes);

}  // namespace internal
}  // namespace hypotrack::calibration
