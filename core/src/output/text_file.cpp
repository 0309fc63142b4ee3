#include "output/text_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "hypotrack/error.hpp"

namespace hypotrack {

TextFile::TextFile(std::filesystem::path path) : path_(std::move(path)), out_(path_) {
  if (!out_)
    throw OutputError(
        fmt::format("{}: cannot be opened for writing: {}", path_.string(), std::strerror(errno)));
}

void TextFile::write(std::string_view text) {
  out_ << text << std::flush;
  if (!out_)
    throw OutputError(
        fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
}

}  // namespace hypotrack
