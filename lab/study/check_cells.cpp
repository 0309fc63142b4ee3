#include "lab/study/check_cells.hpp"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <set>
#include <thread>

#include "cost/cuda/backend_text.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "run/crew/crew.hpp"

namespace hypotrack::study::internal {
namespace {

constexpr std::chrono::milliseconds kCheckPoll{5};
constexpr std::size_t kMostShown = 5;

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

/// Returns the job that checks a cell. A worker has a CUDA context already; a process would take a
/// second to make one.
Job check_of(const Plan& plan, std::size_t index, const Launch& launch, const Crew& crew) {
  const Cell& cell = plan.cells[index];
  Job job{.key = index, .scene = plan.scene_of(cell).file};
  job.set = settings_of(plan.changes_of(cell), plan, launch);
  job.log = crew.scratch() / fmt::format("check_{}", index);
  job.check = true;
  if (!launch.gpus.empty()) job.gpu = launch.gpus.front();
  return job;
}

}  // namespace

std::map<std::size_t, int> check_cells(const Plan& plan, const std::vector<std::size_t>& cells,
                                       const Launch& launch, Crew& crew,
                                       const std::function<bool()>& again) {
  std::map<std::size_t, std::string> problems;
  std::map<std::size_t, int> gpus;
  std::size_t next = 0;
  while (again() && (next < cells.size() || crew.size() > 0)) {
    if (next < cells.size() && crew.has_room()) {
      crew.start(check_of(plan, cells[next++], launch, crew));
      continue;
    }
    const auto ended = crew.take_ended();
    if (!ended) {
      std::this_thread::sleep_for(kCheckPoll);
      continue;
    }
    const std::filesystem::path log = crew.scratch() / fmt::format("check_{}", ended->key);
    if (ended->end.code != 0)
      problems[ended->key] = failure_message(log, *ended);
    else if (const auto gpu = cuda::gpu_in(read_whole(log).value_or("")))
      gpus[ended->key] = *gpu;
  }
  if (crew.size() > 0) crew.kill();  // after an interrupt
  if (!problems.empty()) throw ConfigError(report(plan, problems));
  return gpus;
}

}  // namespace hypotrack::study::internal
