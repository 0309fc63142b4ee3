#include <fmt/format.h>
#include <fmt/ranges.h>

#include "shell/shell_files.hpp"

namespace hypotrack::app {
namespace {

/// Escapes characters with a meaning for _arguments and _describe, and quotes the text.
std::string zsh_quoted(std::string text) {
  return "'" + replace_all(std::move(text), "'", "'\\''") + "'";
}

std::string zsh_escaped(std::string text, const std::string& characters) {
  std::string out;
  for (const char c : text) {
    if (characters.find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string function_of(const std::string& command) {
  return "_" + replace_all(replace_all(command, " ", "_"), "-", "_");
}

/// Writes what completes the value of an option or argument.
std::string zsh_action(const OptionInfo& option) {
  if (!option.words.empty()) return fmt::format("({})", fmt::join(option.words, " "));
  return option.is_path ? "_files" : "";
}

/// Writes an option or argument for _arguments.
std::string specification(const OptionInfo& option) {
  const std::string help = zsh_escaped(option.help, "[]\\");
  const std::string value = zsh_escaped(option.value, ":\\");
  if (option.is_argument())
    return zsh_quoted(
        fmt::format("{}:{}:{}", option.repeats ? "*" : "", option.name, zsh_action(option)));
  if (option.value.empty()) {
    if (option.short_name.empty()) return zsh_quoted(fmt::format("{}[{}]", option.name, help));
    return fmt::format("'({0} {1})'{{{0},{1}}}{2}", option.short_name, option.name,
                       zsh_quoted("[" + help + "]"));
  }
  return zsh_quoted(fmt::format("{}{}=[{}]:{}:{}", option.repeats ? "*" : "", option.name, help,
                                value, zsh_action(option)));
}

std::string zsh_function(const FlatCommand& command) {
  std::string out = fmt::format("{}() {{\n", function_of(command.name));
  if (!command.below.empty()) out += "  local curcontext=\"$curcontext\" state line\n";
  out += command.below.empty() ? "  _arguments" : "  _arguments -C";
  for (const OptionInfo& option : command.options) out += " \\\n    " + specification(option);
  if (command.below.empty()) return out + "\n}\n\n";
  out += " \\\n    '1:command:->command' \\\n    '*::argument:->argument'\n";
  out += "  case $state in\n    command)\n      local -a commands=(\n";
  for (const CommandInfo* below : command.below)
    out += fmt::format("        {}\n", zsh_quoted(zsh_escaped(last_word(below->name), ":\\") + ":" +
                                                  zsh_escaped(below->summary, "\\")));
  out += "      )\n      _describe command commands ;;\n    argument)\n      case $line[1] in\n";
  for (const CommandInfo* below : command.below)
    out += fmt::format("        {}) {} ;;\n", last_word(below->name), function_of(below->name));
  return out + "      esac ;;\n  esac\n}\n\n";
}

}  // namespace

std::string zsh_completion(const CommandInfo& program) {
  std::string out = fmt::format(
      "#compdef {0}\n# Completion of {0} for zsh, made from its command line.\n\n", program.name);
  for (const FlatCommand& command : flatten(program)) out += zsh_function(command);
  return out + fmt::format("_{} \"$@\"\n", program.name);
}

}  // namespace hypotrack::app
