#include "lab/study/study_folder.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "base/text_file.hpp"
#include "hypotrack/api/config.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::study::internal {
namespace {

constexpr const char* kStudyFile = "study.yaml";
constexpr const char* kPlanFile = "plan.txt";
constexpr const char* kLockSuffix = ".lock";

std::string read_text(const std::filesystem::path& file) { return read_whole(file).value_or(""); }

std::string plan_text(const Plan& plan) {
  std::string text;
  for (const PlannedRun& run : plan.runs) text += run.id + "\n";
  return text;
}

/// Returns the differing parts of two studies that decide their runs: `seeds, frames`.
std::string differences(const std::string& old_text, const Plan& plan) {
  const ConfigNode before = ConfigNode::parse(old_text, kStudyFile);
  const ConfigNode now = ConfigNode::parse(to_yaml(plan.study), kStudyFile);
  std::vector<std::string> keys;
  for (const char* key : {"scenes", "grid", "seeds", "frames", "trace"})
    if (before.get(key).to_yaml() != now.get(key).to_yaml()) keys.emplace_back(key);
  const auto redraw = [](const ConfigNode& node) {  // studies without the key redrew nothing
    return node.defined() ? node.scalar() : "nothing";
  };
  if (redraw(before.get("redraw")) != redraw(now.get("redraw")))
    keys.push_back(fmt::format("redraw (the folder's is {})", redraw(before.get("redraw"))));
  if (keys.empty()) return "the content of its scene files differs";
  return fmt::format("they differ in: {}", fmt::join(keys, ", "));
}

}  // namespace

StudyFolder::StudyFolder(std::filesystem::path folder, const Plan& plan)
    : folder_(std::filesystem::absolute(folder).lexically_normal()), plan_(&plan) {
  if (!std::filesystem::exists(folder_)) return;
  if (!std::filesystem::is_directory(folder_))
    throw OutputError(folder_.string() + ": is a file; name a folder with --out");
  if (std::filesystem::exists(folder_ / kPlanFile)) {
    check_same_study();
  } else if (!std::filesystem::is_empty(folder_) && !std::filesystem::exists(working())) {
    throw OutputError(folder_.string() +
                      ": is not empty and holds no study; name another folder with --out");
  }
}

void StudyFolder::check_same_study() const {
  std::set<std::string> planned;
  for (const PlannedRun& run : plan_->runs) planned.insert(run.id);
  std::ifstream in(folder_ / kPlanFile);
  std::size_t all = 0;
  std::size_t foreign = 0;
  for (std::string id; std::getline(in, id); ++all) foreign += !planned.contains(id);
  if (foreign == 0) return;
  throw OutputError(fmt::format(
      "{}: holds another study: {} of its {} runs are not part of this one; {}. A study may grow "
      "in place (further seeds, values or scenes); for anything else name another folder with "
      "--out, or remove this one",
      folder_.string(), foreign, all, differences(read_text(folder_ / kStudyFile), *plan_)));
}

bool StudyFolder::has_plan() const { return std::filesystem::exists(folder_ / kPlanFile); }

bool StudyFolder::begun() const { return read_text(folder_ / kPlanFile) == plan_text(*plan_); }

bool StudyFolder::open() const {
  const bool there = std::filesystem::exists(std::filesystem::symlink_status(folder_));
  make_folder(working());
  if (!open_) open_ = std::make_shared<const OpenFolder>(folder_);
  return !there;
}

void StudyFolder::begin() const {
  open();
  make_folder(folder_ / "runs");
  const FileLock guard = lock();
  // Another study may have begun since the constructor looked.
  if (std::filesystem::exists(folder_ / kPlanFile)) check_same_study();
  write_whole(folder_ / kStudyFile, to_yaml(plan_->study));
  write_whole(folder_ / kPlanFile, plan_text(*plan_));
  remove_leftovers();
}

void StudyFolder::abandon() const {
  if (!open_ || has_plan()) return;
  remove_leftovers();
  std::error_code ignored;  // folders with the work of others stay
  for (const auto& folder : {working(), folder_ / "recordings", folder_})
    std::filesystem::remove(folder, ignored);
}

// Processes that make the runs open files by their paths, which another study may have now.
void StudyFolder::expect_in_place() const {
  if (!open_ || !open_->moved()) return;
  open_->expect_exists();
  throw OutputError(fmt::format(
      "{0}: this folder was renamed to {1} while its study was made; start the study again with "
      "--out {1}, and it goes on there",
      folder_.string(), open_->place().string()));
}

/// Removes everything in the working folder that is not locked: its process has ended.
void StudyFolder::remove_leftovers() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(working()))
    names.push_back(entry.path().filename().string());
  for (const std::string& name : names) {
    const bool is_lock = name.ends_with(kLockSuffix);
    const std::filesystem::path lock_file = working() / (is_lock ? name : name + kLockSuffix);
    if (is_lock && name == fmt::format("tables{}", kLockSuffix)) continue;
    if (const auto unused = FileLock::try_take(lock_file); unused && !is_lock) {
      std::error_code ignored;
      std::filesystem::remove_all(working() / name, ignored);
    }
  }
}

std::filesystem::path StudyFolder::run_path(const PlannedRun& run) const {
  return folder_ / "runs" / run.id;
}

RunState StudyFolder::state(const PlannedRun& run) const {
  if (!std::filesystem::exists(run_path(run))) return RunState::missing;
  return std::filesystem::exists(run_path(run) / "failure.json") ? RunState::failed : RunState::ok;
}

std::optional<RunFolder> StudyFolder::claim(const std::string& id,
                                            const std::filesystem::path& final) const {
  expect_in_place();
  auto lock = FileLock::try_take(working() / (id + kLockSuffix));
  if (!lock) return std::nullopt;
  return std::optional<RunFolder>(std::in_place, *std::move(lock), working() / id, final);
}

std::optional<RunFolder> StudyFolder::claim(const PlannedRun& run) const {
  return claim(run.id, run_path(run));
}

std::filesystem::path StudyFolder::recording_path(const std::string& id) const {
  return folder_ / "recordings" / id;
}

std::optional<RunFolder> StudyFolder::claim_recording(const std::string& id) const {
  make_folder(folder_ / "recordings");
  return claim(id, recording_path(id));
}

FileLock StudyFolder::lock() const {
  expect_in_place();
  return FileLock::wait_for(working() / fmt::format("tables{}", kLockSuffix));
}

}  // namespace hypotrack::study::internal
