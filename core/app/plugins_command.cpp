#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "hypotrack/plugin.hpp"
#include "plugin/inspect.hpp"

namespace hypotrack::app {
namespace {

int list(const CommonOptions& common) {
  const PluginLoader loader(common.plugin_path);
  const std::vector<PluginRow> rows = list_plugins(loader.search_path());
  fmt::print("{}", format_table(rows));
  return 0;
}

int info(const CommonOptions& common, const std::string& name) {
  const PluginLoader loader(common.plugin_path);
  const std::vector<PluginRow> rows = find_plugins(loader.search_path(), name);
  for (const PluginRow& row : rows)
    fmt::print("{}{}", &row == &rows.front() ? "" : "\n", format_info(row));
  return std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.usable(); }) ? 0
                                                                                             : 1;
}

int check(const std::vector<std::filesystem::path>& files) {
  bool usable = true;
  for (const auto& file : files) {
    const PluginRow row = check_plugin(file);
    fmt::print("{}\n", format_check(row));
    usable = usable && row.usable();
  }
  return usable ? 0 : 1;
}

}  // namespace

void add_plugins_command(CLI::App& app, CommonOptions& common, int& exit_code) {
  CLI::App* command = app.add_subcommand("plugins", "Look at plugins");
  command->require_subcommand(1);

  CLI::App* list_command = command->add_subcommand("list", "Every plugin on the search path");
  list_command->callback([&] { exit_code = list(common); });

  auto name = std::make_shared<std::string>();
  CLI::App* info_command =
      command->add_subcommand("info", "What a plugin is and which parameters it takes");
  info_command->add_option("name", *name, "Name (pso), kind (optimizer) or both (optimizer/pso)")
      ->required();
  info_command->callback([&, name] { exit_code = info(common, *name); });

  auto files = std::make_shared<std::vector<std::filesystem::path>>();
  CLI::App* check_command =
      command->add_subcommand("check", "Whether plugin libraries can be used by this build");
  check_command->add_option("files", *files, "Plugin libraries")->required();
  check_command->callback([&, files] { exit_code = check(*files); });

  for (CLI::App* sub : {list_command, info_command, check_command}) sub->fallthrough();
  command->fallthrough();
}

}  // namespace hypotrack::app
