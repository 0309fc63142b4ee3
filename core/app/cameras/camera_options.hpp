#pragma once

#include "cameras/camera_source.hpp"
#include "command_line.hpp"
#include "hypotrack/api/media.hpp"

namespace hypotrack::app {

/// Adds --layout.
void add_layout_option(const Command& command, std::optional<std::string>& layout);

/// Options on the colours of videos.
struct ColorOptions {
  std::optional<std::string> matrix, range;

  VideoColors colors() const {
    return {value_named<ColorMatrix>(matrix), value_named<ColorRange>(range)};
  }
};

/// Adds --color-matrix and --color-range.
void add_color_options(const Command& command, ColorOptions& options);

/// Adds --device, --layout, --size, --fps and --pixel-format; the command itself has --left and
/// --right.
void add_camera_options(const Command& command, CameraOptions& options);

}  // namespace hypotrack::app
