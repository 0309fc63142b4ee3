#include "output/run_directory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

constexpr const char* kPartPrefix = ".part.";

}  // namespace

RunDirectory::RunDirectory(std::filesystem::path directory) : directory_(std::move(directory)) {
  std::error_code error;
  std::filesystem::create_directories(directory_, error);
  if (error || !std::filesystem::is_directory(directory_))
    throw OutputError(
        fmt::format("{}: the output folder cannot be made ({}); name another with --out",
                    directory_.string(), error ? error.message() : "there is a file of that name"));
  if (access(directory_.c_str(), W_OK | X_OK) != 0)
    throw OutputError(fmt::format(
        "{}: the output folder cannot be written; change its permissions or name another with "
        "--out",
        directory_.string()));
  for (const auto& entry : std::filesystem::directory_iterator(directory_))
    if (entry.path().filename().string().starts_with(kPartPrefix))
      std::filesystem::remove(entry.path(), error);
}

std::filesystem::path RunDirectory::part_path(const std::string& name) const {
  return directory_ / (kPartPrefix + name);
}

std::filesystem::path RunDirectory::part(const std::string& name) {
  names_.push_back(name);
  return part_path(name);
}

void RunDirectory::finish(const std::vector<std::string>& stale) {
  for (const std::string& name : names_) {
    std::error_code error;
    std::filesystem::rename(part_path(name), directory_ / name, error);
    if (error)
      throw OutputError(fmt::format("{}: cannot be written ({}); the results so far are in {}",
                                    (directory_ / name).string(), error.message(),
                                    part_path(name).string()));
  }
  for (const std::string& name : stale) {
    std::error_code error;
    if (std::find(names_.begin(), names_.end(), name) == names_.end())
      std::filesystem::remove(directory_ / name, error);
  }
  names_.clear();
}

}  // namespace hypotrack
