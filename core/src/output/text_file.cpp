#include "output/text_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

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

}  // namespace hypotrack
