#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <sstream>
#include <string>

#include "base/descriptor.hpp"
#include "base/subprocess.hpp"
#include "hypotrack/api/error.hpp"
#include "plugin/folders.hpp"
#include "window/window.hpp"
#include "window/window_messages.hpp"

namespace hypotrack {
namespace {

using Clock = std::chrono::steady_clock;

struct SocketPair {
  Descriptor own, other;
};

SocketPair make_socket_pair() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw_system_error(errno, "cannot make a pair of sockets");
  const timeval patience{.tv_sec = 1, .tv_usec = 0};
  setsockopt(ends[0], SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// A file in memory for what a program says.
Descriptor make_memory_file() {
  const int made = memfd_create("hypotrack window", MFD_CLOEXEC);
  if (made < 0) throw_system_error(errno, "cannot make a file in memory");
  return Descriptor(made);
}

/// Returns the first line that tells of an error.
std::string first_error(const Descriptor& file) {
  constexpr std::size_t kMost = 4096;
  std::string text(kMost, '\0');
  const ssize_t size = pread(file.get(), text.data(), text.size(), 0);
  text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && !line.starts_with("QStandardPaths")) return line;  // Qt's usual remark
  return {};
}

/// Returns false if the other side is gone.
bool answer(int socket, const WindowContent& content, const WindowQuestion& question) {
  switch (question.kind) {
    case WindowQuestion::Kind::picture:
      return send_picture(socket, content.picture({question.width, question.height}));
    case WindowQuestion::Kind::key:
      return send_step(socket, content.on_key(question.key));
    case WindowQuestion::Kind::next:
      return send_step(socket, content.next());
  }
  return false;
}

/// Answers until the window is closed. Returns false if it ought to close and does not.
bool serve(int socket, const WindowContent& content) {
  constexpr std::chrono::milliseconds kPeriod{50}, kPatience{500};
  Clock::time_point heard = Clock::now();
  while (true) {
    bool late = false;
    const auto question = receive_question(socket, kPeriod, late);
    if (question) {
      if (!answer(socket, content, *question)) return true;
      heard = Clock::now();
    } else if (!late) {
      return true;
    } else if (Clock::now() - heard > kPatience && content.next() == WindowStep::close) {
      return false;
    }
  }
}

}  // namespace

void show_in_process(const WindowContent& content) {
  constexpr std::chrono::milliseconds kTimeToEnd{500};
  SocketPair sockets = make_socket_pair();
  const Descriptor errors = make_memory_file();
  Subprocess window(
      {.program = detail::libexec_program("hypotrack_window"),
       .arguments = {content.title, std::to_string(content.size.width),
                     std::to_string(content.size.height)},
       .descriptors = {{sockets.other.get(), kWindowSocket}, {errors.get(), STDERR_FILENO}}});
  sockets.other.close();
  if (!serve(sockets.own.get(), content)) return;
  sockets.own.close();
  if (!window.wait_until(Clock::now() + kTimeToEnd))
    throw DeviceError("the window does not answer");
  const int code = window.wait().code;
  if (code == 0) return;
  const std::string said = first_error(errors);
  throw DeviceError(fmt::format("the window's process ended with code {}{}", code,
                                said.empty() ? "" : ": " + said));
}

}  // namespace hypotrack
