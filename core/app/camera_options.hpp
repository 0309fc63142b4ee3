#pragma once

#include "camera_source.hpp"
#include "command_line.hpp"

namespace hypotrack::app {

/// Adds --device, --size, --fps and --pixel-format; the command itself has --left and --right.
void add_camera_options(const Command& command, CameraOptions& options);

}  // namespace hypotrack::app
