#include "base/open_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <utility>

#include "base/system_problem.hpp"

namespace hypotrack::internal {
namespace {

bool are_same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// Throws OutputError.
int opened(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    throw OutputError(
        fmt::format("{}: the folder cannot be opened: {}", folder.string(), described(errno)));
  return descriptor;
}

}  // namespace

OpenFolder::OpenFolder(std::filesystem::path folder)
    : name_(std::move(folder)),
      descriptor_(opened(name_)),
      path_(fmt::format("/proc/self/fd/{}", descriptor_)) {
  if (!has_name(path_)) path_ = name_;  // without /proc
}

OpenFolder::~OpenFolder() { ::close(descriptor_); }

bool OpenFolder::has_name(const std::filesystem::path& name) const {
  struct stat named {};
  struct stat own {};
  return ::stat(name.c_str(), &named) == 0 && ::fstat(descriptor_, &own) == 0 &&
         are_same(named, own);
}

bool OpenFolder::exists() const {
  struct stat own {};
  if (::fstat(descriptor_, &own) != 0 || own.st_nlink == 0) return false;
  if (path_ == name_) return has_name(name_);
  std::error_code error;
  const std::string now = std::filesystem::read_symlink(path_, error).string();
  return error || !now.ends_with(" (deleted)") || has_name(now);
}

std::filesystem::path OpenFolder::place() const {
  if (path_ == name_ || has_name(name_)) return name_;
  std::error_code error;
  std::filesystem::path now = std::filesystem::read_symlink(path_, error);
  return error || !has_name(now) ? name_ : now;
}

void OpenFolder::expect_exists() const {
  if (exists()) return;
  throw OutputError(fmt::format(
      "{}: this folder was removed while results were written there, and they with it; start "
      "again and leave the folder until the program has ended",
      name_.string()));
}

std::string OpenFolder::shown(std::string text) const {
  const std::string own = path_.string();
  if (own == name_.string()) return text;
  const std::string people = place().string();
  for (std::size_t at = 0; (at = text.find(own, at)) != std::string::npos;) {
    const std::size_t end = at + own.size();
    const bool whole = end == text.size() || text[end] < '0' || text[end] > '9';
    if (whole) text.replace(at, own.size(), people);
    at += whole ? people.size() : own.size();
  }
  return text;
}

bool OpenFolder::lock() const {
  return ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

std::string OpenFolder::described(const std::system_error& error) {
  return internal::described(error);
}

}  // namespace hypotrack::internal
