#include "lab/study/check_cells.hpp"

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <set>
#include <thread>

#include "cost/cuda/backend_text.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/text_file.hpp"
#include "run/crew/failure_message.hpp"
#include "run/crew/process_pool.hpp"
#include "run/crew/scratch_folder.hpp"

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

std::vector<std::string> check_arguments(const Plan& plan, const Cell& cell, const Launch& launch) {
  auto arguments =
      scene_arguments("validate", plan.scene_of(cell).file, plan.changes_of(cell), plan, launch);
  if (!launch.gpus.empty())
    arguments.insert(arguments.end(),
                     {"--set", fmt::format("evaluate.device={}", launch.gpus.front())});
  return arguments;
}

}  // namespace

std::map<std::size_t, int> check_cells(const Plan& plan, const std::vector<std::size_t>& cells,
                                       const Launch& launch, const std::function<bool()>& again) {
  const ScratchFolder scratch;
  const auto log = [&](std::size_t cell) { return scratch.path() / fmt::format("{}", cell); };
  ProcessPool pool(launch.time_limit_s);
  std::map<std::size_t, std::string> problems;
  std::map<std::size_t, int> gpus;
  std::size_t next = 0;
  while (again() && (next < cells.size() || pool.size() > 0)) {
    if (next < cells.size() && pool.size() < static_cast<std::size_t>(launch.jobs)) {
      const std::size_t cell = cells[next++];
      pool.start(cell, study_command(launch, plan, check_arguments(plan, plan.cells[cell], launch),
                                     log(cell)));
      continue;
    }
    const auto ended = pool.take_ended();
    if (!ended) {
      std::this_thread::sleep_for(kCheckPoll);
    } else if (ended->end.code != 0) {
      problems[ended->key] = failure_message(log(ended->key), *ended);
    } else if (const auto gpu = cuda::gpu_in(read_whole(log(ended->key)).value_or(""))) {
      gpus[ended->key] = *gpu;
    }
  }
  if (!problems.empty()) throw ConfigError(report(plan, problems));
  return gpus;
}

}  // namespace hypotrack::study::internal
