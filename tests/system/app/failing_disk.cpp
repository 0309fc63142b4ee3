// Loaded before a program (LD_PRELOAD), this makes the disk under $FAILING_DISK read-only once so
// many bytes were written there ($READ_ONLY_AFTER), as Linux does after an error of the disk, or
// delays everything that is written there ($DELAY_MS), as a far file server does.

#include <dlfcn.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdarg>
#include <cstddef>
#include <string>
#include <thread>

namespace {

std::atomic<long> written{0};

long number(const char* name, long otherwise) {
  const char* const text = getenv(name);
  return text ? atol(text) : otherwise;
}

/// Returns the path itself of one that begins at an open folder.
std::string resolved(const std::string& path) {
  constexpr const char* kOpen = "/proc/self/fd/";
  char folder[4096] = {};
  if (!path.starts_with(kOpen)) return path;
  const std::size_t end = std::min(path.find('/', strlen(kOpen)), path.size());
  const ssize_t size = readlink(path.substr(0, end).c_str(), folder, sizeof folder - 1);
  return size > 0 ? folder + path.substr(end) : path;
}

bool is_there(const char* path) {
  const char* const disk = getenv("FAILING_DISK");
  if (!disk || !path) return false;
  const std::string whole =
      path[0] == '/' ? path : std::string(getenv("PWD") ? getenv("PWD") : "") + "/" + path;
  return resolved(whole).starts_with(disk);
}

bool is_there(int file) {
  char path[4096] = {};
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  return readlink(link.c_str(), path, sizeof path - 1) > 0 && is_there(path);
}

/// Returns false, with errno, if the disk takes nothing any more. Waits as long as it takes.
bool takes(std::size_t bytes) {
  std::this_thread::sleep_for(std::chrono::milliseconds(number("DELAY_MS", 0)));
  const long most = number("READ_ONLY_AFTER", -1);
  if (most >= 0 && written.load() >= most) {
    errno = EROFS;
    return false;
  }
  written += static_cast<long>(bytes);
  return true;
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool writes(const char* mode) { return strpbrk(mode, "wa+") != nullptr; }
bool writes(int flags) { return (flags & (O_WRONLY | O_RDWR | O_CREAT)) != 0; }

std::size_t size_of(const iovec* parts, int count) {
  std::size_t size = 0;
  for (int i = 0; i < count; ++i) size += parts[i].iov_len;
  return size;
}

int open_file(const char* name, const char* path, int flags, mode_t mode) {
  if (writes(flags) && is_there(path) && !takes(0)) return -1;
  return next<int (*)(const char*, int, mode_t)>(name)(path, flags, mode);
}

FILE* open_stream(const char* name, const char* path, const char* mode) {
  if (writes(mode) && is_there(path) && !takes(0)) return nullptr;
  return next<FILE* (*)(const char*, const char*)>(name)(path, mode);
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t size) {
  if (is_there(file) && !takes(size)) return -1;
  return next<ssize_t (*)(int, const void*, size_t)>("write")(file, bytes, size);
}

ssize_t writev(int file, const iovec* parts, int count) {
  if (is_there(file) && !takes(size_of(parts, count))) return -1;
  return next<ssize_t (*)(int, const iovec*, int)>("writev")(file, parts, count);
}

size_t fwrite(const void* bytes, size_t size, size_t count, FILE* file) {
  if (is_there(fileno(file)) && !takes(size * count)) return 0;
  return next<size_t (*)(const void*, size_t, size_t, FILE*)>("fwrite")(bytes, size, count, file);
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return open_file("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  return open_file("open64", path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) { return open_stream("fopen", path, mode); }
FILE* fopen64(const char* path, const char* mode) { return open_stream("fopen64", path, mode); }

int rename(const char* from, const char* to) noexcept {
  if (is_there(to) && !takes(0)) return -1;
  return next<int (*)(const char*, const char*)>("rename")(from, to);
}

int mkdir(const char* path, mode_t mode) noexcept {
  if (is_there(path) && !takes(0)) return -1;
  return next<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}

int remove(const char* path) noexcept {
  if (is_there(path) && !takes(0)) return -1;
  return next<int (*)(const char*)>("remove")(path);
}

int unlink(const char* path) noexcept {
  if (is_there(path) && !takes(0)) return -1;
  return next<int (*)(const char*)>("unlink")(path);
}

int statvfs(const char* path, struct statvfs* disk) noexcept {
  const int result = next<int (*)(const char*, struct statvfs*)>("statvfs")(path, disk);
  const long most = number("READ_ONLY_AFTER", -1);
  if (result == 0 && most >= 0 && written.load() >= most && is_there(path))
    disk->f_flag |= ST_RDONLY;
  return result;
}

int statvfs64(const char* path, struct statvfs64* disk) noexcept {
  const int result = next<int (*)(const char*, struct statvfs64*)>("statvfs64")(path, disk);
  const long most = number("READ_ONLY_AFTER", -1);
  if (result == 0 && most >= 0 && written.load() >= most && is_there(path))
    disk->f_flag |= ST_RDONLY;
  return result;
}
}
