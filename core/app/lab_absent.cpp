// Stands in for the lab's commands in a program that was built without the lab.
#include <fmt/format.h>

#include <string>

#include "commands.hpp"
#include "hypotrack/error.hpp"
#include "lab/live/live_view.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the message about a command that is not there.
std::string absent(const std::string& command) {
  return fmt::format(
      "`hypotrack {}` is not in this program, because {}; install libboost-dev, libjs-three, "
      "libjs-vega and libcpp-httplib-dev, and configure with -DHYPOTRACK_LAB=ON",
      command, HYPOTRACK_WHY_NO_LAB);
}

}  // namespace

std::unique_ptr<LiveView> open_live_view(const LiveViewOptions& /*options*/,
                                         RunControls& /*controls*/) {
  throw ConfigError(absent("run --web"));
}

}  // namespace hypotrack::internal

namespace hypotrack::app {
namespace {

/// Adds a command that takes any arguments and says what is missing.
void add_absent(const Command& root, const std::string& name, const std::string& summary) {
  const Command command = root.add_command(name, summary + " (not in this build)");
  command.ignore_others();
  command.on_call([name] { throw ConfigError(absent(name)); });
}

}  // namespace

void add_fit_judge_command(const Command& root, CommonOptions&, int&) {
  add_absent(root, "fit-judge", "Fit a judge to the models of scenes with ground truth");
}
void add_reliability_command(const Command& root, int&) {
  add_absent(root, "reliability", "Compare sigmas with true errors");
}
void add_compare_command(const Command& root, CommonOptions&, int&) {
  add_absent(root, "compare", "Run a study: scenes, settings and seeds, and tabulate it");
}
void add_bench_command(const Command& root, CommonOptions&, int&) {
  add_absent(root, "bench", "Measure how fast scenes are tracked");
}
void add_landscape_command(const Command& root, CommonOptions&, int&) {
  add_absent(root, "landscape", "Draw slices of the cost around the true or tracked pose");
}
void add_report_command(const Command& root, CommonOptions&, int&) {
  add_absent(root, "report", "Write one page about a study or a run");
}

}  // namespace hypotrack::app
