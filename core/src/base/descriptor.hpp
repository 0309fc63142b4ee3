#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

[[noreturn]] inline void throw_system_error(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// A file descriptor that its destructor closes. Its number is at least 16, above the
/// descriptors that started programs get. Programs do not inherit it.
class Descriptor {
 public:
  /// Takes over a descriptor and changes its number. Throws std::system_error.
  explicit Descriptor(int opened) : value_(fcntl(opened, F_DUPFD_CLOEXEC, 16)) {
    const int error = errno == EINVAL ? EMFILE : errno;  // 16 is beyond the limit
    ::close(opened);
    if (value_ < 0) throw_system_error(error, "cannot duplicate a file descriptor");
  }
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;

  int get() const { return value_; }
  void close() {
    if (value_ >= 0) ::close(value_);
    value_ = -1;
  }

 private:
  int value_;
};

struct Pipe {
  Descriptor read_end, write_end;
};

/// Makes a pipe. Throws std::system_error.
inline Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw_system_error(errno, "cannot make a pipe");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

}  // namespace internal
}  // namespace hypotrack
