#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <string>

namespace hypotrack {

/// What a window does next.
enum class WindowStep { wait, redraw, close };

/// What a window shows, and whom it tells of the user. All functions are called from the thread
/// that shows the window.
struct WindowContent {
  std::string title;
  /// Size of the pictures' area at first; empty: that of the first picture, made to fit.
  cv::Size size = {};
  /// Returns the picture, 8-bit BGR. `area`: size in which it is shown, in pixels.
  std::function<cv::Mat(cv::Size area)> picture;
  /// Receives clicks of the left button, in pixels of the picture. May be null.
  std::function<void(cv::Point)> on_click = nullptr;
  std::function<WindowStep(char key)> on_key;
  /// Is asked many times a second. May be null.
  std::function<WindowStep()> next = nullptr;
};

/// Shows a window until it is closed by a step or the user. Exported by the module
/// `hypotrack_window` under the name kShowWindow. Throws cv::Exception if there is no display.
using ShowWindow = void (*)(const WindowContent& content);
inline constexpr const char* kShowWindow = "hypotrack_show_window";

/// Loads the module that shows windows. Throws DeviceError if that is not possible.
ShowWindow load_window();

/// Shows a window by a process of its own, so that a toolkit of windows that fails or loses its
/// display does not end this program. Clicks are not told of. Throws DeviceError if that process
/// fails, std::system_error if it cannot be started.
void show_in_process(const WindowContent& content);

/// Throws DeviceError if no window can be shown. `instead` says what the user can do then.
void check_display(const std::string& instead);

/// Returns the size of the screen in pixels, of all monitors together; that of a small screen if it
/// is unknown.
cv::Size screen_size();

}  // namespace hypotrack
