// The module that holds the lab's commands.
#include "lab_commands/lab_commands.hpp"

extern "C" [[gnu::visibility("default")]] const hypotrack::app::LabCommands&
hypotrack_lab_commands() {
  using namespace hypotrack::app;
  static constexpr LabCommands kCommands{.add_fit_judge = add_fit_judge_command,
                                         .add_reliability = add_reliability_command,
                                         .add_compare = add_compare_command,
                                         .add_bench = add_bench_command,
                                         .add_report = add_report_command,
                                         .add_landscape = add_landscape_command,
                                         .open_live_view = hypotrack::open_live_view};
  return kCommands;
}
