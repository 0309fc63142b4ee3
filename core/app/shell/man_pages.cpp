#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "shell/shell_files.hpp"

namespace hypotrack::app {
namespace {

/// Escapes what has a meaning for troff.
std::string roff_escaped(std::string text) {
  text = replace_all(replace_all(std::move(text), "\\", "\\e"), "-", "\\-");
  return text.starts_with('.') || text.starts_with('\'') ? "\\&" + text : text;
}

/// Returns the name of a command's page: hypotrack-plugins-info.
std::string page_of(const std::string& command) { return replace_all(command, " ", "-"); }

std::string entry(const OptionInfo& option) {
  std::string out = ".TP\n";
  if (!option.short_name.empty())
    out += fmt::format("\\fB{}\\fR, ", roff_escaped(option.short_name));
  out += fmt::format("\\f{}{}\\fR", option.is_argument() ? 'I' : 'B', roff_escaped(option.name));
  if (!option.is_argument() && !option.value.empty())
    out += fmt::format(" \\fI{}\\fR", roff_escaped(option.value));
  out += "\n" + roff_escaped(option.help);
  for (const std::string& word : option.words)
    out += (&word == &option.words.front() ? ": " : ", ") + roff_escaped(word);
  if (!option.default_value.empty())
    out += fmt::format(" (default: {})", roff_escaped(option.default_value));
  return out + "\n";
}

std::string section(const std::string& title, const std::vector<OptionInfo>& options,
                    bool arguments) {
  std::string out;
  for (const OptionInfo& option : options)
    if (option.is_argument() == arguments) out += entry(option);
  return out.empty() ? out : fmt::format(".SH {}\n{}", title, out);
}

std::string synopsis(const FlatCommand& command) {
  std::string out =
      fmt::format(".SH SYNOPSIS\n\\fB{}\\fR [\\fIOPTIONS\\fR]", roff_escaped(command.name));
  if (!command.below.empty()) out += " \\fICOMMAND\\fR";
  for (const OptionInfo& option : command.options) {
    if (!option.is_argument()) continue;
    const std::string name =
        fmt::format("\\fI{}\\fR{}", roff_escaped(option.name), option.repeats ? " ..." : "");
    out += option.required ? " " + name : " [" + name + "]";
  }
  return out + "\n";
}

std::string commands(const FlatCommand& command) {
  if (command.below.empty()) return {};
  std::string out = ".SH COMMANDS\n";
  for (const CommandInfo* below : command.below)
    out += fmt::format(".TP\n\\fB{}\\fR(1)\n{}\n", roff_escaped(page_of(below->name)),
                       roff_escaped(below->summary));
  return out;
}

std::string page_text(const FlatCommand& command, const std::string& program,
                      const std::string& version) {
  std::string title = page_of(command.name);
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
  std::string out = fmt::format(".TH \"{}\" 1 \"\" \"{} {}\" \"User Commands\"\n",
                                roff_escaped(title), program, version);
  out += fmt::format(".SH NAME\n{} \\- {}\n", roff_escaped(page_of(command.name)),
                     roff_escaped(command.summary));
  out += synopsis(command) + commands(command) + section("ARGUMENTS", command.options, true) +
         section("OPTIONS", command.options, false);
  if (command.name == program)
    return out +
           ".SH EXIT STATUS\n0: success. 1: an error, which is printed. 2: a mistake in the "
           "command "
           "line. 3: some of several runs failed. 130: ended by Ctrl\\-C.\n";
  return out + fmt::format(".SH SEE ALSO\n\\fB{}\\fR(1)\n",
                           roff_escaped(page_of(command.name.substr(0, command.name.rfind(' ')))));
}

}  // namespace

std::vector<ManPage> man_pages(const CommandInfo& program, const std::string& version) {
  std::vector<ManPage> out;
  for (const FlatCommand& command : flatten(program))
    out.push_back({page_of(command.name) + ".1", page_text(command, program.name, version)});
  return out;
}

}  // namespace hypotrack::app
