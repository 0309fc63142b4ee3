#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>
#include <system_error>
#include <vector>

#include "base/standard_streams.hpp"
#include "commands.hpp"
#include "hypotrack/plugin/build_tag.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "lab_commands/lab_commands.hpp"
#include "messages.hpp"
#include "plugin/crash_report.hpp"

namespace hypotrack::app {

void add_scene_options(const Command& command, SceneOptions& options) {
  command.add("scene", &options.scene, "Scene file (YAML)", {.required = true});
  add_set_option(command, options.set);
}

void add_set_option(const Command& command, std::vector<std::string>& set) {
  command.add("--set", &set,
              "Change a key of the scene: key.path=value (list items by index; may be repeated)",
              {.value_name = "KEY=VALUE"});
}

namespace {

/// Flushes stdout. Returns whether all output was written.
bool close_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return true;
  tell("hypotrack: the standard output cannot be written: {}\n",
       std::generic_category().message(errno));
  return false;
}

}  // namespace
}  // namespace hypotrack::app

int main(int argc, char** argv) {
  using namespace hypotrack::app;
  hypotrack::open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on file sizes is then an error of writing
  const hypotrack::detail::CrashReport crash_report;
  const hypotrack::detail::EarlyExitReport exit_report;
  CommandLine line("Model-based 3D tracking from RGB stereo pairs.",
                   fmt::format("hypotrack {} (plugin ABI {}: {})", HYPOTRACK_VERSION,
                               hypotrack::kAbiVersion, hypotrack::kBuildTag));
  const Command root = line.root();
  CommonOptions common;
  root.add("--plugin-path", &common.plugin_path,
           "Folder to look for plugins in first (may be repeated)", {.check = existing_folder()});
  int exit_code = 0;
  add_run_command(root, common, exit_code);
  add_validate_command(root, common, exit_code);
  add_click_command(root, common, exit_code);
  add_fit_shape_command(root, common, exit_code);
  lab().commands->add_fit_judge(root, common, exit_code);
  add_record_command(root, common, exit_code);
  add_synth_command(root, common, exit_code);
  add_evaluate_command(root, exit_code);
  lab().commands->add_reliability(root, exit_code);
  lab().commands->add_compare(root, common, exit_code);
  lab().commands->add_bench(root, common, exit_code);
  lab().commands->add_report(root, common, exit_code);
  lab().commands->add_landscape(root, common, exit_code);
  add_calibrate_command(root, common, exit_code);
  add_calibration_command(root, exit_code);
  add_plugins_command(root, common, exit_code);
  add_new_command(root, common, exit_code);
  add_get_command(root);
  add_migrate_command(root);
  add_doctor_command(root, common, exit_code);
  add_work_command(root, common, exit_code);
  add_shell_files_command(line);
  try {
    if (const int mistake = line.run(argc, argv); mistake != 0) return mistake;
    return close_output() ? exit_code : 1;
  } catch (...) {
    tell("hypotrack: {}\n", failure_text());
  }
  return 1;
}
