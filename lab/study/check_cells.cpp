#include "lab/study/check_cells.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <chrono>
#include <map>
#include <set>
#include <system_error>
#include <thread>

#include "hypotrack/error.hpp"
#include "lab/study/failure_message.hpp"
#include "lab/study/process_pool.hpp"

namespace hypotrack::study::internal {
namespace {

constexpr std::chrono::milliseconds kCheckPoll{5};
constexpr std::size_t kMostShown = 5;

/// A temporary folder for the logs of the checks.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "hypotrack_XXXXXX").string();
    if (!mkdtemp(name.data()))
      throw OutputError(name + ": cannot make a temporary folder; set TMPDIR to one with room");
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::filesystem::path log(std::size_t cell) const { return path_ / fmt::format("{}", cell); }

 private:
  std::filesystem::path path_;
};

/// Returns the line of the study that a message is about: that of the change it names, or the
/// scene's.
std::string position_of(const Plan& plan, const Cell& cell, const std::string& message) {
  for (const Change& change : plan.changes_of(cell))
    if (message.find("--set " + change.assignment()) != std::string::npos) return change.where;
  return plan.scene_of(cell).where;
}

/// Joins all problems to one message; names the same problem of several cells once.
std::string report(const Plan& plan, const std::map<std::size_t, std::string>& problems) {
  std::set<std::string> known;
  std::string text;
  for (const auto& [index, message] : problems) {
    if (!known.insert(message).second || known.size() > kMostShown) continue;
    const Cell& cell = plan.cells[index];
    text += fmt::format("{}{}: {}: {}", text.empty() ? "" : "\n  ",
                        position_of(plan, cell, message), plan.describe(cell), message);
  }
  return text + fmt::format("\n  {} of the study's {} cells cannot be run; nothing was run",
                            problems.size(), plan.cells.size());
}

}  // namespace

void check_cells(const Plan& plan, const std::vector<std::size_t>& cells, const Launch& launch,
                 const std::function<bool()>& again) {
  const Scratch scratch;
  ProcessPool pool(launch.time_limit_s);
  std::map<std::size_t, std::string> problems;
  std::size_t next = 0;
  while (again() && (next < cells.size() || pool.size() > 0)) {
    if (next < cells.size() && pool.size() < static_cast<std::size_t>(launch.jobs)) {
      const std::size_t cell = cells[next++];
      pool.start(cell,
                 study_command(launch, plan,
                               scene_arguments("validate", plan.scene_of(plan.cells[cell]).file,
                                               plan.changes_of(plan.cells[cell]), plan, launch),
                               scratch.log(cell)));
      continue;
    }
    const auto ended = pool.take_ended();
    if (!ended) std::this_thread::sleep_for(kCheckPoll);
    if (ended && ended->end.code != 0)
      problems[ended->key] = failure_message(scratch.log(ended->key), *ended);
  }
  if (!problems.empty()) throw ConfigError(report(plan, problems));
}

}  // namespace hypotrack::study::internal
