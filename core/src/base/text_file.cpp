#include "base/text_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/system_problem.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, int problem) {
  throw OutputError(fmt::format(
      "{}: cannot be written{}; check that the folder exists, is writable and has space",
      file.string(), problem == 0 ? "" : fmt::format(" ({})", std::strerror(problem))));
}

/// Writes into a device or pipe, such as /dev/stdout.
void write_into(const std::filesystem::path& file, std::string_view text) {
  // A pipe that nobody reads would wait for ever.
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) refuse(file, errno);
  ::fcntl(descriptor, F_SETFL, 0);  // from here on, a slow reader is waited for
  int problem = 0;
  while (!text.empty() && problem == 0) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written >= 0)
      text.remove_prefix(static_cast<std::size_t>(written));
    else if (errno != EINTR)
      problem = errno;
  }
  ::close(descriptor);
  if (problem != 0) refuse(file, problem);
}

}  // namespace

TextFile::TextFile(std::filesystem::path path) : path_(std::move(path)) {
  constexpr mode_t kMode = 0666;  // less what umask takes
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, kMode);
  if (descriptor_ < 0)
    throw OutputError(fmt::format("{}: cannot be opened for writing: {}", path_.string(),
                                  is_shortage(errno) ? described(errno)
                                                     : std::string(std::strerror(errno)) +
                                                           "; name another folder with --out"));
}

TextFile::TextFile(TextFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_) {}

TextFile::~TextFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void TextFile::write(std::string_view text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t written = ::write(descriptor_, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int problem = errno;
      // A torn line would look like a whole one to who reads the file.
      [[maybe_unused]] const int cut = ::ftruncate(descriptor_, size_);
      throw OutputError(fmt::format(
          "{}: cannot be written: {}; the lines before this one are in the file. Make room or name "
          "another folder with --out",
          path_.string(), std::strerror(problem)));
    }
    done += static_cast<std::size_t>(written);
  }
  size_ += static_cast<std::int64_t>(done);
}

}  // namespace hypotrack

namespace hypotrack::internal {

void expect_writable(const std::filesystem::path& file, std::string_view option) {
  if (std::filesystem::is_directory(file))
    throw OutputError(fmt::format("{}: is a folder; name a file with {}", file.string(), option));
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (file.empty() || !std::filesystem::is_directory(folder) ||
      access(folder.c_str(), W_OK | X_OK) != 0)
    throw OutputError(fmt::format(
        "{}: cannot be written; check that the folder exists and is writable, or name another file "
        "with {}",
        file.string(), option));
}

void write_whole(const std::filesystem::path& file, std::string_view text) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (is_character_file(status) || is_fifo(status)) return write_into(file, text);
  // Keeps a link: the file that it names is replaced.
  const bool is_link = std::filesystem::is_symlink(std::filesystem::symlink_status(file, error));
  std::filesystem::path target = is_link ? std::filesystem::canonical(file, error) : file;
  if (target.empty()) target = file;
  const std::filesystem::path partial = target.string() + fmt::format(".{}.partial", ::getpid());
  errno = 0;
  std::ofstream out(partial, std::ios::binary);
  out << text;
  out.close();
  error.assign(out ? 0 : errno, std::generic_category());
  if (out) {
    std::filesystem::rename(partial, target, error);
    if (!error) return;
  }
  std::error_code ignored;
  std::filesystem::remove(partial, ignored);
  refuse(file, error.value());
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw OutputError(fmt::format("{}: the folder cannot be made ({}); name another with --out",
                                  folder.string(),
                                  error ? error.message() : "there is a file of that name"));
}

}  // namespace hypotrack::internal
