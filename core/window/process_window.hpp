#pragma once

#include "window/window.hpp"

namespace hypotrack {

/// Shows a window by a process of its own, so that a toolkit of windows that fails or loses its
/// display does not end this program. Clicks are not told of. Throws DeviceError if that process
/// fails, std::system_error if it cannot be started.
void show_in_process(const WindowContent& content);

}  // namespace hypotrack
