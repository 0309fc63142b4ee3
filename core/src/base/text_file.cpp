#include "base/text_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "hypotrack/error.hpp"

namespace hypotrack {

TextFile::TextFile(std::filesystem::path path) : path_(std::move(path)), out_(path_) {
  if (!out_)
    throw OutputError(
        fmt::format("{}: cannot be opened for writing: {}; name another folder with --out",
                    path_.string(), std::strerror(errno)));
}

void TextFile::write(std::string_view text) {
  errno = 0;
  out_ << text << std::flush;
  if (!out_)
    throw OutputError(fmt::format(
        "{}: cannot be written: {}; the lines before this one are in the file. Make room or name "
        "another folder with --out",
        path_.string(), errno != 0 ? std::strerror(errno) : "unknown reason"));
}

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
  const std::filesystem::path partial = file.string() + fmt::format(".{}.partial", ::getpid());
  errno = 0;
  std::ofstream out(partial, std::ios::binary);
  out << text;
  out.close();
  std::error_code error(out ? 0 : errno, std::generic_category());
  if (out) {
    std::filesystem::rename(partial, file, error);
    if (!error) return;
  }
  std::error_code ignored;
  std::filesystem::remove(partial, ignored);
  throw OutputError(fmt::format(
      "{}: cannot be written{}; check that the folder exists, is writable and has space",
      file.string(), error ? " (" + error.message() + ")" : std::string()));
}

}  // namespace hypotrack
