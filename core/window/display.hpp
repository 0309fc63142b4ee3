#pragma once

#include <opencv2/core/types.hpp>
#include <string>

namespace hypotrack {

/// Throws DeviceError if no window can be shown. `instead` says what the user can do then.
void check_display(const std::string& instead);

/// Returns the size of the screen in pixels, of all monitors together; that of a small screen if it
/// is unknown.
cv::Size screen_size();

}  // namespace hypotrack
