#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "config/yaml.hpp"
#include "hypotrack/api/stereo_layout.hpp"

namespace hypotrack::app {

/// Live cameras on a command line: parameters of the source `camera`.
struct CameraOptions {
  std::string device;       ///< both views in its picture; otherwise left and right
  std::string left, right;  ///< devices, or files
  std::optional<std::string> size, fps;
  std::string pixel_format;
  std::optional<std::string> layout = {};  ///< of pictures of both views
};

/// Returns the value of an enumeration that has this name, if one is given.
template <class Enum>
std::optional<Enum> value_named(const std::optional<std::string>& name) {
  const auto names = enum_names(Enum());
  for (std::size_t i = 0; name && i < names.size(); ++i)
    if (names[i] == *name) return static_cast<Enum>(i);
  return std::nullopt;
}

inline std::optional<StereoLayout> layout_of(const CameraOptions& options) {
  return value_named<StereoLayout>(options.layout);
}

/// Returns whether the options name live cameras: numbers, /dev/..., URLs or GStreamer pipelines.
/// Throws ConfigError if they name a camera and a file, or settings without a camera.
bool names_cameras(const CameraOptions& options);

/// Returns the source `camera` without its calibration. Throws ConfigError for a wrong size.
detail::YamlDocument camera_source(const CameraOptions& options);

}  // namespace hypotrack::app
