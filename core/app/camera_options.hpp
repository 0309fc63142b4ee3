#pragma once

#include "camera_source.hpp"
#include "command_line.hpp"

namespace hypotrack::app {

/// Adds --layout.
void add_layout_option(const Command& command, std::optional<std::string>& layout);

/// Adds --device, --layout, --size, --fps and --pixel-format; the command itself has --left and
/// --right.
void add_camera_options(const Command& command, CameraOptions& options);

}  // namespace hypotrack::app
