#pragma once

#include "window/window.hpp"

namespace hypotrack {

/// Loads the module that shows windows. Throws DeviceError if that is not possible.
ShowWindow load_window();

}  // namespace hypotrack
