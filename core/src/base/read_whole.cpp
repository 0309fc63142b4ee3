#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "hypotrack/text_file.hpp"

namespace hypotrack {

std::optional<std::string> read_whole(const std::filesystem::path& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"),
                                                           &std::fclose);
  if (!in) {
    const int problem = errno;
    if (problem == EMFILE || problem == ENFILE || problem == ENOMEM)
      throw std::system_error(problem, std::generic_category(),
                              file.string() + ": cannot be opened");
    return std::nullopt;
  }
  std::string bytes;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  // One byte more than the file has shows its end. Pipes have no size, and files may grow.
  std::size_t room = error ? 4096 : size + 1;
  while (true) {
    const std::size_t before = bytes.size();
    bytes.resize(before + room);
    const std::size_t read = std::fread(bytes.data() + before, 1, room, in.get());
    bytes.resize(before + read);
    if (read < room) break;
    room = bytes.size();
  }
  if (std::ferror(in.get()) != 0) return std::nullopt;
  return bytes;
}

}  // namespace hypotrack
