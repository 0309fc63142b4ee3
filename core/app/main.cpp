#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "base/suggest.hpp"
#include "commands.hpp"
#include "hypotrack/build_tag.hpp"
#include "hypotrack/error.hpp"
#include "hypotrack/plugin.hpp"
#include "tell.hpp"

namespace hypotrack::app {

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command.add_option("scene", options.scene, "Scene file (YAML)")->required();
  add_set_option(command, options.set);
}

void add_set_option(CLI::App& command, std::vector<std::string>& set) {
  command
      .add_option("--set", set,
                  "Change a key of the scene: key.path=value (list items by index; may be "
                  "repeated)")
      ->allow_extra_args(false)
      ->take_all()
      ->type_name("KEY=VALUE");
}

namespace {

/// What was wrong with the command line, and what there is where a word is no command.
std::string mistake(const CLI::App* app, const CLI::Error& error) {
  const std::string way_out = "\nRun with --help for more information.\n";
  const std::vector<std::string> left = app->remaining();
  if (!app->get_subcommands().empty() || left.empty() || left.front().starts_with('-'))
    return error.what() + way_out;
  std::vector<std::string> commands;
  for (const CLI::App* command : app->get_subcommands({})) commands.push_back(command->get_name());
  const std::string hint = detail::did_you_mean(left.front(), commands);
  return fmt::format("there is no command '{}'{} There are: {}{}", left.front(),
                     hint.empty() ? "." : hint, fmt::join(commands, ", "), way_out);
}

/// Whether all that was printed has arrived.
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
  CLI::App app("Model-based 3D tracking from RGB stereo pairs.", "hypotrack");
  app.require_subcommand(1);
  app.failure_message(mistake);
  app.set_version_flag("--version",
                       fmt::format("hypotrack {} (plugin ABI {}: {})", HYPOTRACK_VERSION,
                                   hypotrack::kAbiVersion, hypotrack::kBuildTag));
  CommonOptions common;
  app.add_option("--plugin-path", common.plugin_path,
                 "Folder to look for plugins in first (may be repeated)")
      ->allow_extra_args(false)
      ->take_all();
  app.fallthrough();
  int exit_code = 0;
  add_run_command(app, common, exit_code);
  add_validate_command(app, common, exit_code);
  add_fit_shape_command(app, common, exit_code);
  add_synth_command(app, common, exit_code);
  add_evaluate_command(app, exit_code);
  add_reliability_command(app, exit_code);
  add_compare_command(app, common, exit_code);
  add_bench_command(app, common, exit_code);
  add_report_command(app, common, exit_code);
  add_plugins_command(app, common, exit_code);
  try {
    app.parse(argc, argv);
    return close_output() ? exit_code : 1;
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const hypotrack::Error& e) {
    tell("hypotrack: {}\n", e.what());
  } catch (const std::bad_alloc&) {
    tell("hypotrack: out of memory\n");
  } catch (const std::system_error& e) {  // of a full disk for what is printed
    tell("hypotrack: {}\n", e.what());
  } catch (const std::exception& e) {
    tell("hypotrack: unexpected error: {}\n", e.what());
  } catch (...) {
    tell(
        "hypotrack: unexpected error: a plugin threw something that is no "
        "std::exception\n");
  }
  return 1;
}
