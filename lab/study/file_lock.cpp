#include "lab/study/file_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "hypotrack/api/error.hpp"

namespace hypotrack::study::internal {
namespace {

std::string error_text() { return std::generic_category().message(errno); }

/// Returns whether the name still refers to the locked file. The last owner may have removed it
/// between open and flock.
bool is_current(const std::filesystem::path& file, int descriptor) {
  struct stat named {};
  struct stat opened {};
  return stat(file.c_str(), &named) == 0 && fstat(descriptor, &opened) == 0 &&
         named.st_ino == opened.st_ino && named.st_dev == opened.st_dev;
}

void write_owner(int descriptor) {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  const std::string owner = fmt::format("{} {}\n", host.data(), getpid());
  // Only people read the content; the lock works without it.
  [[maybe_unused]] const bool written =
      ftruncate(descriptor, 0) == 0 && write(descriptor, owner.data(), owner.size()) > 0;
}

}  // namespace

FileLock::FileLock(std::filesystem::path file, int descriptor)
    : file_(std::move(file)), descriptor_(descriptor) {}

FileLock::FileLock(FileLock&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  unlink(file_.c_str());  // while locked, so that it cannot be another owner's file
  close(descriptor_);
}

std::optional<FileLock> FileLock::take(const std::filesystem::path& file, bool wait) {
  while (true) {
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor < 0)
      throw OutputError(fmt::format("{}: cannot be made: {}; check that its folder can be written",
                                    file.string(), error_text()));
    int result = 0;
    do {
      result = flock(descriptor, LOCK_EX | (wait ? 0 : LOCK_NB));
    } while (result != 0 && errno == EINTR);
    if (result == 0 && is_current(file, descriptor)) {
      write_owner(descriptor);
      return FileLock(file, descriptor);
    }
    const int error = result == 0 ? 0 : errno;
    close(descriptor);
    if (error == EWOULDBLOCK) return std::nullopt;
    errno = error;
    if (error != 0)
      throw OutputError(fmt::format(
          "{}: cannot be locked: {}; the study needs a file system with file locks (flock)",
          file.string(), error_text()));
  }
}

FileLock FileLock::wait_for(const std::filesystem::path& file) { return *take(file, true); }

std::optional<FileLock> FileLock::try_take(const std::filesystem::path& file) {
  return take(file, false);
}

}  // namespace hypotrack::study::internal
