#include <fcntl.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

#include "base/system_problem.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack {

std::string why_not_written(const std::filesystem::path& file) {
  constexpr std::uintmax_t kFull = 1 << 16;  // bytes that are left
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  struct statvfs disk {};
  if (statvfs(folder.c_str(), &disk) == 0) {
    if (disk.f_flag & ST_RDONLY) return std::strerror(EROFS);
    if (std::uintmax_t{disk.f_bavail} * disk.f_frsize < kFull) return std::strerror(ENOSPC);
  }
  rlimit limit{};
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  const bool too_large = !error && getrlimit(RLIMIT_FSIZE, &limit) == 0 && size >= limit.rlim_cur;
  if (too_large) return std::strerror(EFBIG);
  const int opened = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (opened < 0 && is_shortage(errno)) return described(errno);
  if (opened >= 0) ::close(opened);
  const bool forbidden = ::access(folder.c_str(), W_OK | X_OK) != 0 && errno == EACCES;
  return forbidden ? std::strerror(EACCES) : "";
}

}  // namespace hypotrack
