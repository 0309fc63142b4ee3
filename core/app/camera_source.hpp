#pragma once

#include <optional>
#include <string>

#include "config/yaml.hpp"

namespace hypotrack::app {

/// Live cameras on a command line: parameters of the source `camera`.
struct CameraOptions {
  std::string device;       ///< both views side by side; otherwise left and right
  std::string left, right;  ///< devices, or files
  std::optional<std::string> size, fps;
  std::string pixel_format;
};

/// Returns whether the options name live cameras: numbers, /dev/..., URLs or GStreamer pipelines.
/// Throws ConfigError if they name a camera and a file, or settings without a camera.
bool names_cameras(const CameraOptions& options);

/// Returns the source `camera` without its calibration. Throws ConfigError for a wrong size.
detail::YamlDocument camera_source(const CameraOptions& options);

}  // namespace hypotrack::app
