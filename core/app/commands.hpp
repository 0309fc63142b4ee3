#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

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
void add_scene_options(CLI::App& command, SceneOptions& options);
void add_set_option(CLI::App& command, std::vector<std::string>& set);

/// Checks of an option's value; their messages say what is expected.
CLI::Validator whole_number(std::int64_t lowest,
                            std::int64_t highest = std::numeric_limits<int>::max());
CLI::Validator positive_number();
CLI::Validator file_name();

// Each adds one subcommand, whose callback does the work and sets `exit_code`.
void add_run_command(CLI::App& app, CommonOptions& common, int& exit_code);
void add_validate_command(CLI::App& app, CommonOptions& common, int& exit_code);
void add_fit_shape_command(CLI::App& app, CommonOptions& common, int& exit_code);
void add_synth_command(CLI::App& app, CommonOptions& common, int& exit_code);
void add_evaluate_command(CLI::App& app, int& exit_code);
void add_reliability_command(CLI::App& app, int& exit_code);
void add_compare_command(CLI::App& app, CommonOptions& common, int& exit_code);
void add_bench_command(CLI::App& app, CommonOptions& common, int& exit_code);
void add_report_command(CLI::App& app, CommonOptions& common, int& exit_code);
void add_plugins_command(CLI::App& app, CommonOptions& common, int& exit_code);

}  // namespace hypotrack::app
