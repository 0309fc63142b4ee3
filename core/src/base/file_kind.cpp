#include "base/file_kind.hpp"

#include <system_error>

namespace hypotrack::internal {

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

}  // namespace hypotrack::internal
