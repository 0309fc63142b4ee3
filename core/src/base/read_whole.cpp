#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "base/file_bytes.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

std::optional<FileBytes> read_bytes(const std::filesystem::path& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                           &std::fclose);
  if (!in) {
    const int problem = errno;
    if (problem == EMFILE || problem == ENFILE || problem == ENOMEM)
      throw std::system_error(problem, std::generic_category(),
                              file.string() + ": cannot be opened");
    return std::nullopt;
  }
  std::error_code error;
  const std::uintmax_t expected = std::filesystem::file_size(file, error);
  // One byte more than the file has shows its end. Pipes have no size, and files may grow.
  std::size_t room = error ? 4096 : expected + 1;
  FileBytes bytes{std::make_unique_for_overwrite<char[]>(room)};
  while (true) {
    bytes.size += std::fread(bytes.memory.get() + bytes.size, 1, room - bytes.size, in.get());
    if (bytes.size < room) break;
    room *= 2;
    auto larger = std::make_unique_for_overwrite<char[]>(room);
    std::copy_n(bytes.memory.get(), bytes.size, larger.get());
    bytes.memory = std::move(larger);
  }
  if (std::ferror(in.get()) != 0) return std::nullopt;
  return bytes;
}

std::string why_no_file(const std::filesystem::path& path) {
  std::error_code error;
  switch (std::filesystem::status(path, error).type()) {
    case std::filesystem::file_type::regular:
      return {};
    case std::filesystem::file_type::directory:
      return "is a folder";
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::character:
      return "is a device";
    case std::filesystem::file_type::fifo:
      return "is a pipe";
    case std::filesystem::file_type::not_found:
      return "no such file";
    default:
      return error ? "cannot be read: " + error.message() : "is no file";
  }
}

}  // namespace internal

std::optional<std::string> read_whole(const std::filesystem::path& file) {
  const std::optional<FileBytes> bytes = read_bytes(file);
  if (!bytes) return std::nullopt;
  return std::string(bytes->view());
}

}  // namespace hypotrack
