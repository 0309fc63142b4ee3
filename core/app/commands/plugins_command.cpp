#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "model_info.hpp"
#include "plugin/capabilities.hpp"
#include "plugin/inspect.hpp"

namespace hypotrack::app {
namespace {

int list(const CommonOptions& common) {
  const PluginLoader loader(common.plugin_path);
  const std::vector<PluginRow> rows = list_plugins(loader.search_path());
  fmt::print("{}", format_table(rows));
  return 0;
}

/// Returns what a model has, or why that cannot be said.
std::string text_on_model(PluginLoader& loader, const PluginRow& row,
                          const std::vector<std::string>& settings, bool markdown) {
  try {
    const ModelInfo found = describe_model(loader, row.name, settings);
    return markdown ? format_model_markdown(found) : format_model(found);
  } catch (const Error& error) {
    if (!settings.empty()) throw;
    if (markdown) return "\nDegrees of freedom and landmarks depend on the parameters.\n";
    return fmt::format("degrees of freedom: depend on the parameters; give them with --set ({})\n",
                       error.what());
  }
}

int info(const CommonOptions& common, const std::string& name,
         const std::vector<std::string>& settings, bool markdown) {
  PluginLoader loader(common.plugin_path);
  const std::vector<PluginRow> rows = find_plugins(loader.search_path(), name);
  for (const PluginRow& row : rows) {
    fmt::print("{}{}", &row == &rows.front() ? "" : "\n",
               markdown ? format_markdown(row) : format_info(row));
    if (row.usable() && row.kind == "model")
      fmt::print("{}", text_on_model(loader, row, settings, markdown));
  }
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

void print_measures(bool markdown) {
  if (markdown) fmt::print("| measure | range | meaning |\n|---|---|---|\n");
  for (const MeasureInfo& one : measure_infos())
    markdown ? fmt::print("| `{}` | {} | {} |\n", one.name, one.range, one.meaning)
             : fmt::print("{:16} {:10} {}\n", one.name, one.range, one.meaning);
}

}  // namespace

void add_plugins_command(const Command& root, CommonOptions& common, int& exit_code) {
  const Command command = root.add_command("plugins", "Look at plugins, write new ones");
  command.need_command();

  command.add_command("list", "Every plugin on the search path").on_call([&] {
    exit_code = list(common);
  });

  auto name = std::make_shared<std::string>();
  const Command info_command =
      command.add_command("info", "What a plugin is and which parameters it takes");
  info_command.add("name", name.get(), "Name (pso), kind (optimizer) or both (optimizer/pso)",
                   {.required = true});
  auto markdown = std::make_shared<bool>(false);
  info_command.add("--markdown", markdown.get(), "Print a page for the documentation");
  auto settings = std::make_shared<std::vector<std::string>>();
  info_command.add("--set", settings.get(), "A parameter of a model, as file=lamp.urdf",
                   {.value_name = "KEY=VALUE"});
  info_command.on_call(
      [=, &common, &exit_code] { exit_code = info(common, *name, *settings, *markdown); });

  auto as_table = std::make_shared<bool>(false);
  const Command capabilities =
      command.add_command("capabilities", "What the words under a plugin's capabilities mean");
  capabilities.add("--markdown", as_table.get(), "Print a table for the documentation");
  capabilities.on_call([=] {
    fmt::print("{}", *as_table ? format_capabilities_markdown() : format_capabilities());
  });

  auto as_rows = std::make_shared<bool>(false);
  const Command measures =
      command.add_command("measures", "What judges know about the pose of a model");
  measures.add("--markdown", as_rows.get(), "Print a table for the documentation");
  measures.on_call([=] { print_measures(*as_rows); });

  add_new_plugin_command(command, common, exit_code);

  auto files = std::make_shared<std::vector<std::filesystem::path>>();
  const Command check_command =
      command.add_command("check", "Whether plugin libraries can be used by this build");
  check_command.add("files", files.get(), "Plugin libraries", {.required = true});
  check_command.on_call([&, files] { exit_code = check(*files); });
}

}  // namespace hypotrack::app
