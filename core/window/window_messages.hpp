#pragma once

#include <chrono>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "window/window.hpp"

// What a window's process and the program say to each other over a socket. Both are of one build.

namespace hypotrack {

/// A question of the window's process; the program answers each before the next one.
struct WindowQuestion {
  enum class Kind {
    picture,  ///< for the area `width` x `height`; the answer is a picture
    key,      ///< `key` was pressed; the answer is a WindowStep
    next      ///< the answer is a WindowStep
  };
  Kind kind = Kind::next;
  int width = 0, height = 0;
  char key = 0;
};

/// The socket's number in the window's process.
inline constexpr int kWindowSocket = 3;

// Each returns false, or nothing, if the other side is gone.

bool send_question(int socket, const WindowQuestion& question);
/// Waits for a question for some time. `late` is set if none came in time.
std::optional<WindowQuestion> receive_question(int socket, std::chrono::milliseconds time,
                                               bool& late);
bool send_step(int socket, WindowStep step);
std::optional<WindowStep> receive_step(int socket);
/// Sends an 8-bit BGR picture.
bool send_picture(int socket, const cv::Mat& picture);
std::optional<cv::Mat> receive_picture(int socket);

}  // namespace hypotrack
