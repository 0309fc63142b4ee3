#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "command_line.hpp"

namespace hypotrack::app {

/// Options of every subcommand that opens plugins.
struct CommonOptions {
  std::vector<std::filesystem::path> plugin_path;
};

/// A scene and the changes made to it on the command line.
struct SceneOptions {
  std::filesystem::path scene;
  std::vector<std::string> set;
};
void add_scene_options(const Command& command, SceneOptions& options);
void add_set_option(const Command& command, std::vector<std::string>& set);

// Each adds one command, which does the work and sets `exit_code`.
void add_run_command(const Command& root, CommonOptions& common, int& exit_code);
void add_validate_command(const Command& root, CommonOptions& common, int& exit_code);
void add_click_command(const Command& root, CommonOptions& common, int& exit_code);
void add_fit_shape_command(const Command& root, CommonOptions& common, int& exit_code);
void add_fit_judge_command(const Command& root, CommonOptions& common, int& exit_code);
void add_record_command(const Command& root, CommonOptions& common, int& exit_code);
void add_synth_command(const Command& root, CommonOptions& common, int& exit_code);
void add_evaluate_command(const Command& root, int& exit_code);
void add_reliability_command(const Command& root, int& exit_code);
void add_compare_command(const Command& root, CommonOptions& common, int& exit_code);
void add_bench_command(const Command& root, CommonOptions& common, int& exit_code);
void add_landscape_command(const Command& root, CommonOptions& common, int& exit_code);
void add_report_command(const Command& root, CommonOptions& common, int& exit_code);
void add_calibrate_command(const Command& root, CommonOptions& common, int& exit_code);
void add_calibration_command(const Command& root, int& exit_code);
void add_plugins_command(const Command& root, CommonOptions& common, int& exit_code);
/// Adds the command `new` below `plugins`.
void add_new_plugin_command(const Command& plugins, CommonOptions& common, int& exit_code);
void add_new_command(const Command& root, CommonOptions& common, int& exit_code);
void add_get_command(const Command& root);
void add_migrate_command(const Command& root);
void add_doctor_command(const Command& root, CommonOptions& common, int& exit_code);
/// Adds a hidden command, a worker of `run` and `compare`.
void add_work_command(const Command& root, CommonOptions& common, int& exit_code);
/// Adds a hidden command that writes completions and manual pages of all commands.
void add_shell_files_command(CommandLine& line);

}  // namespace hypotrack::app
