#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>

namespace hypotrack::clicking {

/// What a window shows, and whom it tells of the user.
struct WindowContent {
  std::string title;
  std::function<cv::Mat()> picture;         ///< 8-bit BGR; asked for after every event
  std::function<void(cv::Point)> on_click;  ///< left button at a pixel of the picture
  std::function<bool(char key)> on_key;     ///< false: close the window
};

/// Shows a window until a key or the user closes it. Exported by the module `hypotrack_window`
/// under the name kShowWindow. Throws cv::Exception if there is no display.
using ShowWindow = void (*)(const WindowContent& content);
inline constexpr const char* kShowWindow = "hypotrack_show_window";

}  // namespace hypotrack::clicking
