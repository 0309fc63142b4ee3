// The only source that includes CLI11, which takes long to compile.
#include "command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

#include "hypotrack/api/text.hpp"

namespace hypotrack::app {
namespace {

template <class T>
constexpr bool kIsList = false;
template <class T>
constexpr bool kIsList<std::vector<T>> = true;
template <class T>
constexpr bool kIsPath = std::is_same_v<T, std::filesystem::path> ||
                         std::is_same_v<T, std::optional<std::filesystem::path>> ||
                         std::is_same_v<T, std::vector<std::filesystem::path>>;
constexpr const char* kPathName = "PATH";  // of a value, in the help

std::vector<const CLI::App*> shown_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// Returns a message about a wrong command line, with the valid commands if a word is not one.
std::string mistake(const CLI::App* app, const CLI::Error& error) {
  const std::string way_out = "\nRun with --help for more information.\n";
  const std::vector<std::string> left = app->remaining();
  if (!app->get_subcommands().empty() || left.empty() || left.front().starts_with('-'))
    return error.what() + way_out;
  std::vector<std::string> commands;
  for (const CLI::App* command : shown_commands(*app)) commands.push_back(command->get_name());
  const bool is_former = left.front() == "start" && !app->get_parent();  // its name in 0.2
  const std::string hint =
      is_former ? "; it is `click` now." : did_you_mean(left.front(), commands);
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
          if constexpr (kIsPath<T>) option->type_name(kPathName);
          if constexpr (kIsList<T>)
            if (name.starts_with('-')) option->allow_extra_args(false)->take_all();
          return option;
        }
      },
      target);
}

/// Returns the words of a list {a,b,c}; nothing if the text is no such list.
std::vector<std::string> listed_words(std::string_view text) {
  std::vector<std::string> words;
  if (!text.starts_with('{') || !text.ends_with('}')) return words;
  text = text.substr(1, text.size() - 2);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

OptionInfo info_of(const CLI::Option& option) {
  OptionInfo info;
  const bool argument = option.get_lnames().empty();
  info.name = argument ? option.get_name(true) : "--" + option.get_lnames().front();
  if (!option.get_snames().empty()) info.short_name = "-" + option.get_snames().front();
  info.help = option.get_description();
  info.default_value = option.get_default_str();
  info.required = option.get_required();
  if (option.get_items_expected_max() == 0) return info;  // a flag
  const std::string type =
      option.get_type_name();  // and what OptionCheck::hint says, after a colon
  const std::size_t colon = std::min(type.find(':'), type.size());
  info.value = type.substr(0, colon);
  info.words = listed_words(std::string_view(type).substr(std::min(colon + 1, type.size())));
  info.is_path = info.value == kPathName;
  info.repeats = option.get_items_expected_max() > 1;
  return info;
}

CommandInfo info_of(const CLI::App& app, const std::string& name) {
  CommandInfo info{name, app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) info.options.push_back(info_of(*option));
  for (const CLI::App* command : shown_commands(app))
    info.commands.push_back(info_of(*command, name + " " + command->get_name()));
  return info;
}

/// Overwrites an option and its value (`--option VALUE`, `--option=VALUE`) among a program's
/// arguments, which every user of the computer may read in the list of processes.
void wipe(std::string_view option, std::span<char*> arguments) {
  bool is_value = false;
  for (char* const argument : arguments) {
    const std::string_view word = argument;
    const bool alone = word == option;
    const bool joined = word.starts_with(option) && word.substr(option.size()).starts_with('=');
    if (is_value || alone || joined) std::fill_n(argument, word.size(), '\0');
    is_value = alone;
  }
}

}  // namespace

Command Command::add_command(const std::string& name, const std::string& summary) const {
  CLI::App* command = app_->add_subcommand(name, summary);
  command->fallthrough();
  return Command(*command, *secrets_);
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
  if (rules.secret) secrets_->push_back(name);
}

void Command::hide() const { app_->group(""); }

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

Command CommandLine::root() { return Command(*app_, secrets_); }

CommandInfo CommandLine::info() const { return info_of(*app_, app_->get_name()); }

int CommandLine::run(int argc, char** argv) {
  const std::span<char*> given(argv, static_cast<std::size_t>(argc));
  std::vector<std::string> words;  // without the program's name, the last one first
  for (std::size_t i = given.size(); i > 1; --i) words.emplace_back(given[i - 1]);
  for (const std::string& option : secrets_) wipe(option, given);
  try {
    app_->parse(std::move(words));
    return 0;
  } catch (const CLI::ParseError& e) {
    return app_->exit(e) == 0 ? 0 : 2;
  }
}

}  // namespace hypotrack::app
