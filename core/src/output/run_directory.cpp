#include "output/run_directory.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

constexpr const char* kPartPrefix = ".part.";

}  // namespace

bool is_result(std::string_view name, std::string_view result) {
  const std::size_t hash = result.find('#');
  if (hash == std::string_view::npos) return name == result;
  const std::string_view head = result.substr(0, hash), tail = result.substr(hash + 1);
  if (name.size() <= head.size() + tail.size()) return false;
  if (!name.starts_with(head) || !name.ends_with(tail)) return false;
  const auto digits = name.substr(head.size(), name.size() - head.size() - tail.size());
  return digits.find_first_not_of("0123456789") == std::string_view::npos;
}

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
  // Check this now: found at the end, it would cost the whole run.
  for (const std::string& name : results_there(""))
    if (std::filesystem::is_directory(directory_ / name))
      throw OutputError(fmt::format(
          "{}: is a folder, and a result of the run has this name; move it away or name "
          "another output folder with --out",
          (directory_ / name).string()));
  spare_foreign_files();
  lock();
  for (const std::string& name : results_there(kPartPrefix))
    std::filesystem::remove(directory_ / name, error);
}

void RunDirectory::spare_foreign_files() const {
  const std::vector<std::string> there = results_there("");
  const std::vector<std::string> parts = results_there(kPartPrefix);  // of a run that was killed at
                                                                      // its end
  const bool of_a_run =
      std::ranges::any_of(
          there, [&](const std::string& name) { return is_result(name, results_.front()); }) ||
      std::ranges::find(parts, kPartPrefix + results_.front()) != parts.end();
  if (there.empty() || of_a_run) return;
  throw OutputError(fmt::format(
      "{}: a run would replace or remove this file, which is not of a run (there is no {} beside "
      "it); name another folder with --out, or move it away",
      (directory_ / there.front()).string(), results_.front()));
}

RunDirectory::~RunDirectory() {
  if (!keep_) {
    std::error_code ignored;
    for (const std::string& name : names_) std::filesystem::remove(part_path(name), ignored);
    if (made_) std::filesystem::remove(directory_, ignored);  // succeeds only if it is empty
  }
  if (descriptor_ >= 0) close(descriptor_);
}

void RunDirectory::lock() {
  descriptor_ = open(directory_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  // Without support for locks, go on.
  if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(descriptor_);
  throw OutputError(fmt::format(
      "{}: another run is writing its results there; name another folder with --out, or wait for "
      "its end",
      directory_.string()));
}

std::filesystem::path RunDirectory::part_path(const std::string& name) const {
  return directory_ / (kPartPrefix + name);
}

std::vector<std::string> RunDirectory::results_there(const std::string& prefix) const {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory_, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix)) continue;
    const std::string_view result = std::string_view(name).substr(prefix.size());
    if (std::any_of(results_.begin(), results_.end(),
                    [&](const std::string& allowed) { return is_result(result, allowed); }))
      names.push_back(name);
  }
  return names;
}

std::filesystem::path RunDirectory::part(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (std::ranges::find(names_, name) == names_.end()) names_.push_back(name);
  return part_path(name);
}

void RunDirectory::finish() {
  keep_ = true;
  // All or none: look before the first is renamed.
  for (const std::string& name : names_)
    if (!std::filesystem::exists(part_path(name)))
      throw OutputError(fmt::format("{}: was never written, so the results stay in {}*",
                                    part_path(name).string(), part_path("").string()));
  for (const std::string& name : names_) {
    std::error_code error;
    std::filesystem::rename(part_path(name), directory_ / name, error);
    if (error)
      throw OutputError(fmt::format("{}: cannot be written ({}); the results so far are in {}",
                                    (directory_ / name).string(), error.message(),
                                    part_path(name).string()));
  }
  for (const std::string& name : results_there("")) {
    std::error_code error;
    if (std::find(names_.begin(), names_.end(), name) == names_.end())
      std::filesystem::remove(directory_ / name, error);
  }
  names_.clear();
}

}  // namespace hypotrack
