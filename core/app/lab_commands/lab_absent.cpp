// Stands in for the lab's commands where its module is absent.
#include <fmt/format.h>

#include <string>

#include "hypotrack/api/error.hpp"
#include "lab_commands/lab_commands.hpp"

namespace hypotrack::app {
namespace {

/// Returns the message about a command that is not there.
std::string absent(const std::string& command) {
  return fmt::format("`hypotrack {}` needs the lab, which is absent: {}; {}", command,
                     lab().absence.why, lab().absence.fix);
}

std::unique_ptr<LiveView> open_live_view(const LiveViewOptions& /*options*/,
                                         RunControls& /*controls*/) {
  throw ConfigError(absent("run --web"));
}

/// Adds a command that takes any arguments and says what is missing.
void add_absent(const Command& root, const std::string& name, const std::string& summary) {
  const Command command = root.add_command(name, summary + " (not installed)");
  command.ignore_others();
  command.on_call([name] { throw ConfigError(absent(name)); });
}

void add_fit_judge(const Command& root, CommonOptions&, int&) {
  add_absent(root, "fit-judge", "Fit a judge to the models of scenes with ground truth");
}
void add_reliability(const Command& root, int&) {
  add_absent(root, "reliability", "Compare sigmas with true errors");
}
void add_compare(const Command& root, CommonOptions&, int&) {
  add_absent(root, "compare", "Run a study: scenes, settings and seeds, and tabulate it");
}
void add_bench(const Command& root, CommonOptions&, int&) {
  add_absent(root, "bench", "Measure how fast scenes are tracked");
}
void add_report(const Command& root, CommonOptions&, int&) {
  add_absent(root, "report", "Write one page about a study or a run");
}
void add_landscape(const Command& root, CommonOptions&, int&) {
  add_absent(root, "landscape", "Draw slices of the cost around the true or tracked pose");
}

}  // namespace

const LabCommands& absent_lab_commands() {
  static constexpr LabCommands kCommands{.add_fit_judge = add_fit_judge,
                                         .add_reliability = add_reliability,
                                         .add_compare = add_compare,
                                         .add_bench = add_bench,
                                         .add_report = add_report,
                                         .add_landscape = add_landscape,
                                         .open_live_view = open_live_view};
  return kCommands;
}

}  // namespace hypotrack::app
