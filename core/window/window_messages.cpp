#include "window/window_messages.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <cerrno>

namespace hypotrack {
namespace {

bool send_all(int socket, const void* data, std::size_t size) {
  const auto* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = send(socket, at, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
  return true;
}

bool receive_all(int socket, void* data, std::size_t size) {
  auto* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t received = recv(socket, at, size, 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) return false;
    at += received;
    size -= static_cast<std::size_t>(received);
  }
  return true;
}

}  // namespace

bool send_question(int socket, const WindowQuestion& question) {
  return send_all(socket, &question, sizeof question);
}

std::optional<WindowQuestion> receive_question(int socket, std::chrono::milliseconds time,
                                               bool& late) {
  pollfd wanted{.fd = socket, .events = POLLIN, .revents = 0};
  late = poll(&wanted, 1, static_cast<int>(time.count())) <= 0;
  WindowQuestion question;
  if (late || !receive_all(socket, &question, sizeof question)) return std::nullopt;
  return question;
}

bool send_step(int socket, WindowStep step) { return send_all(socket, &step, sizeof step); }

std::optional<WindowStep> receive_step(int socket) {
  WindowStep step = WindowStep::wait;
  if (!receive_all(socket, &step, sizeof step)) return std::nullopt;
  return step;
}

bool send_picture(int socket, const cv::Mat& picture) {
  const cv::Mat whole = picture.isContinuous() ? picture : picture.clone();
  const cv::Size size = whole.size();
  return send_all(socket, &size, sizeof size) &&
         send_all(socket, whole.data, whole.total() * whole.elemSize());
}

std::optional<cv::Mat> receive_picture(int socket) {
  cv::Size size;
  if (!receive_all(socket, &size, sizeof size)) return std::nullopt;
  cv::Mat picture(size, CV_8UC3);
  if (!receive_all(socket, picture.data, picture.total() * picture.elemSize())) return std::nullopt;
  return picture;
}

}  // namespace hypotrack
