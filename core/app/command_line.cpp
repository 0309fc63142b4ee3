// The only source that includes CLI11, which takes long to compile.
#include "command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <type_traits>
#include <utility>

#include "hypotrack/suggest.hpp"

namespace hypotrack::app {
namespace {

template <class T>
constexpr bool kIsList = false;
template <class T>
constexpr bool kIsList<std::vector<T>> = true;

/// Returns a message about a wrong command line, with the valid commands if a word is not one.
std::string mistake(const CLI::App* app, const CLI::Error& error) {
  const std::string way_out = "\nRun with --help for more information.\n";
  const std::vector<std::string> left = app->remaining();
  if (!app->get_subcommands().empty() || left.empty() || left.front().starts_with('-'))
    return error.what() + way_out;
  std::vector<std::string> commands;
  for (const CLI::App* command : app->get_subcommands({})) commands.push_back(command->get_name());
  const std::string hint = did_you_mean(left.front(), commands);
  return fmt::format("there is no command '{}'{} There are: {}{}", left.front(),
                     hint.empty() ? "." : hint, fmt::join(commands, ", "), way_out);
}

CLI::Option* add_to(CLI::App& app, const std::string& name, OptionTarget target,
                    const std::string& help) {
  return std::visit(
      [&](auto* value) -> CLI::Option* {
        using T = std::remove_pointer_t<decltype(value)>;
        if constexpr (std::is_same_v<T, bool>) {
          return app.add_flag(name, *value, help);
        } else {
          CLI::Option* option = app.add_option(name, *value, help);
          if constexpr (kIsList<T>)
            if (name.starts_with('-')) option->allow_extra_args(false)->take_all();
          return option;
        }
      },
      target);
}

}  // namespace

Command Command::add_command(const std::string& name, const std::string& summary) const {
  CLI::App* command = app_->add_subcommand(name, summary);
  command->fallthrough();
  return Command(*command);
}

void Command::add(const std::string& name, OptionTarget target, const std::string& help,
                  const OptionRules& rules) const {
  CLI::Option* option = add_to(*app_, name, target, help);
  if (rules.required) option->required();
  if (rules.check.problem) {
    const auto problem = rules.check.problem;
    option->check(
        CLI::Validator([problem](std::string& text) { return problem(text); }, rules.check.hint));
  }
  if (rules.show_default) option->capture_default_str();
  if (!rules.value_name.empty()) option->type_name(rules.value_name);
  if (!rules.excludes.empty()) option->excludes(app_->get_option(rules.excludes));
  if (!rules.if_bare.empty()) option->expected(0, 1)->default_str(rules.if_bare);
  if (rules.commas) option->delimiter(',');
}

void Command::need_command() const { app_->require_subcommand(1); }

void Command::ignore_others() const {
  app_->allow_extras();
  app_->fallthrough(false);  // else the program itself gets them, and refuses them
}

void Command::on_call(std::function<void()> action) const { app_->callback(std::move(action)); }

CommandLine::CommandLine(const std::string& description, const std::string& version)
    : app_(std::make_unique<CLI::App>(description, "hypotrack")) {
  app_->require_subcommand(1);
  app_->failure_message(mistake);
  app_->set_version_flag("--version", version);
  app_->fallthrough();
}

CommandLine::~CommandLine() = default;

Command CommandLine::root() const { return Command(*app_); }

int CommandLine::run(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& e) {
    return app_->exit(e) == 0 ? 0 : 2;
  }
}

}  // namespace hypotrack::app
