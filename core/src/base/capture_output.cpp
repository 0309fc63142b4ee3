#include <poll.h>

#include <algorithm>
#include <array>

#include "base/descriptor.hpp"
#include "base/subprocess.hpp"

namespace hypotrack::internal {
namespace {

using Clock = std::chrono::steady_clock;
using Deadline = std::optional<Clock::time_point>;

/// Waits until a pipe has something to read or has ended. Returns false at the deadline.
bool wait_readable(int pipe, const Deadline& deadline) {
  for (;;) {
    std::chrono::milliseconds left = std::chrono::hours(1);
    if (deadline)
      left = std::min(
          left, std::chrono::duration_cast<std::chrono::milliseconds>(*deadline - Clock::now()));
    if (left.count() <= 0) return false;
    pollfd waiting{pipe, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(left.count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) throw_system_error(errno, "cannot wait for a pipe");
  }
}

/// Reads a pipe to its end, the deadline, or beyond a number of bytes.
std::string read_pipe(int pipe, const Deadline& deadline, std::size_t bytes) {
  std::string text;
  std::array<char, 1 << 16> chunk;
  while (text.size() <= bytes && wait_readable(pipe, deadline)) {
    const ssize_t size = read(pipe, chunk.data(), chunk.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) throw_system_error(errno, "cannot read a pipe");
    if (size == 0) break;
    text.append(chunk.data(), static_cast<std::size_t>(size));
  }
  return text;
}

}  // namespace

Captured capture_output(Subprocess::Command command, const std::vector<int>& numbers,
                        const CaptureLimits& limits) {
  const Deadline deadline = limits.time ? Deadline(Clock::now() + *limits.time) : std::nullopt;
  Pipe pipe = make_pipe();
  for (const int number : numbers) command.descriptors.emplace_back(pipe.write_end.get(), number);
  Subprocess process(command);
  pipe.write_end.close();  // so that the pipe ends with the program
  Captured captured;
  captured.output = read_pipe(pipe.read_end.get(), deadline, limits.bytes);
  captured.too_large = captured.output.size() > limits.bytes;
  captured.timed_out = deadline && !captured.too_large && !process.wait_until(*deadline);
  if (captured.too_large || captured.timed_out) process.kill();
  captured.end = process.wait();
  return captured;
}

}  // namespace hypotrack::internal
