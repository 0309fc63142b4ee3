#include "lab/result_folder.hpp"

#include <fmt/format.h>

#include <system_error>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder))
    throw OutputError(fmt::format("{}: the folder cannot be made ({}); name another with --out",
                                  folder.string(),
                                  error ? error.message() : "there is a file of that name"));
}

}  // namespace hypotrack::internal
