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

RunDirectory::RunDirectory(std::filesystem::path directory, std::vector<std::string> results)
    : directory_(std::move(directory)), results_(std::move(results)) {
  std::error_code error;
  made_ = std::filesystem::create_directories(directory_, error);
  if (error || !std::filesystem::is_directory(directory_))
    throw OutputError(
        fmt::format("{}: the output folder cannot be made ({}); name another with --out",
                    directory_.string(), error ? error.message() : "there is a file of that name"));
  if (access(directory_.c_str(), W_OK | X_OK) != 0)
    throw OutputError(fmt::format(
        "{}: the output folder cannot be written; change its permissions or name another with "
        "--out",
        directory_.string()));
  // Found at the end, this would cost the whole run.
  for (const std::string& name : results_)
    if (std::filesystem::is_directory(directory_ / name))
      throw OutputError(fmt::format(
          "{}: is a folder, and a result of the run has this name; move it away or name "
          "another output folder with --out",
          (directory_ / name).string()));
  for (const std::string& name : results_) std::filesystem::remove(part_path(name), error);
}

RunDirectory::~RunDirectory() {
  if (keep_) return;
  std::error_code ignored;
  for (const std::string& name : names_) std::filesystem::remove(part_path(name), ignored);
  if (made_) std::filesystem::remove(directory_, ignored);  // only if it is empty
}

std::filesystem::path RunDirectory::part_path(const std::string& name) const {
  return directory_ / (kPartPrefix + name);
}

std::filesystem::path RunDirectory::part(const std::string& name) {
  names_.push_back(name);
  return part_path(name);
}

void RunDirectory::finish() {
  keep_ = true;
  for (const std::string& name : names_) {
    std::error_code error;
    std::filesystem::rename(part_path(name), directory_ / name, error);
    if (error)
      throw OutputError(fmt::format("{}: cannot be written ({}); the results so far are in {}",
                                    (directory_ / name).string(), error.message(),
                                    part_path(name).string()));
  }
  for (const std::string& name : results_) {
    std::error_code error;
    if (std::find(names_.begin(), names_.end(), name) == names_.end())
      std::filesystem::remove(directory_ / name, error);
  }
  names_.clear();
}

}  // namespace hypotrack
