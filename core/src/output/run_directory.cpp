#include "output/run_directory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

constexpr const char* kFirst = "run.yaml";     // of every run
constexpr const char* kUnfinished = ".part.";  // before the name of the last result

/// Throws OutputError that says what failed, after an error of the file system.
[[noreturn]] void fail(const std::filesystem::path& file, const std::error_code& error) {
  throw OutputError(fmt::format(
      "{}: cannot be moved or removed ({}); check the permissions of its folder, or name another "
      "with --out",
      file.string(), error.message()));
}

}  // namespace

void expect_finished_run(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / kFirst) || std::filesystem::exists(folder / kSummaryFile))
    return;
  throw DataError(fmt::format(
      "{}: the run has not ended, or was killed: it has a {} and no {}; wait for its end, or run "
      "it again",
      folder.string(), kFirst, kSummaryFile));
}

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
    : given_(std::move(directory)), results_(std::move(results)) {
  open();
  folder_->write_with([&] {
    // Check this now: found at the end, it would cost the whole run.
    for (const std::string& name : results_in(directory_))
      if (std::filesystem::is_directory(directory_ / name))
        throw OutputError(fmt::format(
            "{}: is a folder, and a result of the run has this name; move it away or name "
            "another output folder with --out",
            (directory_ / name).string()));
    spare_foreign_files();
    lock();
    set_aside();
  });
}

void RunDirectory::open() {
  std::error_code error;
  made_ = std::filesystem::create_directories(given_, error);
  if (error || !std::filesystem::is_directory(given_))
    throw OutputError(
        fmt::format("{}: the output folder cannot be made ({}); name another with --out",
                    given_.string(), error ? error.message() : "there is a file of that name"));
  if (access(given_.c_str(), W_OK | X_OK) != 0)
    throw OutputError(fmt::format(
        "{}: the output folder cannot be written; change its permissions or name another with "
        "--out",
        given_.string()));
  folder_.emplace(given_);
  directory_ = folder_->path();
  previous_ = directory_ / ".previous";
  moving_ = directory_ / ".previous.moving";
}

void RunDirectory::spare_foreign_files() const {
  const std::vector<std::string> there = results_in(directory_);
  const bool of_a_run = std::ranges::find(there, results_.front()) != there.end() ||
                        std::filesystem::exists(moving_ / results_.front());
  if (there.empty() || of_a_run) return;
  throw OutputError(fmt::format(
      "{}: a run would replace or remove this file, which is not of a run (there is no {} beside "
      "it); name another folder with --out, or move it away",
      (directory_ / there.front()).string(), results_.front()));
}

RunDirectory::~RunDirectory() {
  if (!keep_) {
    std::error_code ignored;
    for (const std::string& name : names_) std::filesystem::remove(path_of(name), ignored);
    try {
      put_back();
    } catch (const OutputError&) {  // the next run does it
    }
    // Succeeds only if it is empty.
    if (made_ && folder_->exists()) std::filesystem::remove(folder_->place(), ignored);
  }
}

void RunDirectory::move_all(const std::filesystem::path& from, const std::filesystem::path& to,
                            const std::vector<std::string>& names) {
  std::error_code error;
  std::filesystem::create_directory(to, error);
  if (error) fail(to, error);
  for (const std::string& name : names) {
    std::filesystem::rename(from / name, to / name, error);
    if (error) fail(from / name, error);
  }
}

// A kill may come after any of these steps. While `.previous.moving` exists, what is there and in
// the folder is of one run. Afterwards the earlier run is whole in `.previous`.
void RunDirectory::set_aside() {
  std::error_code error;
  std::filesystem::remove(directory_ / (kUnfinished + results_.back()), error);
  if (std::filesystem::exists(moving_)) put_back_moved();
  const std::vector<std::string> there = results_in(directory_);
  const bool finished = std::ranges::find(there, results_.back()) != there.end();
  if (std::filesystem::exists(previous_)) {
    if (finished) {  // killed when it had just finished
      std::filesystem::remove_all(previous_, error);
      if (error) fail(previous_, error);
    } else {
      for (const std::string& name : there) {
        std::filesystem::remove(directory_ / name, error);
        if (error) fail(directory_ / name, error);
      }
      return;
    }
  }
  if (there.empty()) return;
  move_all(directory_, moving_, there);
  std::filesystem::rename(moving_, previous_, error);
  if (error) fail(moving_, error);
}

void RunDirectory::put_back() {
  if (!std::filesystem::exists(previous_)) return;
  std::error_code error;
  std::filesystem::rename(previous_, moving_, error);
  if (error) fail(previous_, error);
  put_back_moved();
}

void RunDirectory::put_back_moved() {
  std::vector<std::string> names;  // perhaps of outputs that this run does not have
  for (const auto& entry : std::filesystem::directory_iterator(moving_))
    names.push_back(entry.path().filename().string());
  move_all(moving_, directory_, names);
  std::error_code ignored;
  std::filesystem::remove(moving_, ignored);
}

void RunDirectory::lock() const {
  if (folder_->lock()) return;
  throw OutputError(fmt::format(
      "{}: another run is writing its results there; name another folder with --out, or wait for "
      "its end",
      directory_.string()));
}

std::filesystem::path RunDirectory::path_of(const std::string& name) const {
  return directory_ / (name == results_.back() ? kUnfinished + name : name);
}

std::vector<std::string> RunDirectory::results_in(const std::filesystem::path& folder) const {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (std::ranges::any_of(results_,
                            [&](const std::string& result) { return is_result(name, result); }))
      names.push_back(name);
  }
  return names;
}

std::filesystem::path RunDirectory::file(const std::string& name) {
  const std::lock_guard lock(mutex_);
  if (std::ranges::find(names_, name) == names_.end()) names_.push_back(name);
  return path_of(name);
}

void RunDirectory::finish() {
  keep_ = true;
  folder_->expect_exists();
  for (const std::string& name : names_)
    if (!std::filesystem::exists(path_of(name)))
      throw OutputError(fmt::format("{}: was never written, so the run counts as unfinished",
                                    path_of(name).string()));
  std::error_code error;
  std::filesystem::rename(path_of(results_.back()), directory_ / results_.back(), error);
  if (error)
    throw OutputError(fmt::format("{}: cannot be written ({}); the results so far are in {}",
                                  (directory_ / results_.back()).string(), error.message(),
                                  directory_.string()));
  names_.clear();
  std::filesystem::remove_all(previous_, error);  // the next run does it if this fails
}

}  // namespace hypotrack::internal
