#include <fmt/format.h>
#include <fmt/ranges.h>

#include "shell/shell_files.hpp"

namespace hypotrack::app {
namespace {

std::string fish_quoted(std::string text) {
  return "'" + replace_all(replace_all(std::move(text), "\\", "\\\\"), "'", "\\'") + "'";
}

/// Writes the completions that hold for one command.
std::string completions(const std::string& program, const FlatCommand& command) {
  const std::string begin =
      fmt::format("complete -c {0} -n '__{0}_is \"{1}\"'", program, command.name);
  std::string out;
  for (const CommandInfo* below : command.below)
    out +=
        fmt::format("{} -a {} -d {}\n", begin, last_word(below->name), fish_quoted(below->summary));
  for (const OptionInfo& option : command.options) {
    if (option.is_argument()) {
      if (option.is_path) out += begin + " -F\n";
      continue;
    }
    out += fmt::format("{} -l {}", begin, option.name.substr(2));
    if (!option.short_name.empty()) out += fmt::format(" -s {}", option.short_name.substr(1));
    if (option.is_path)
      out += " -r -F";
    else if (!option.words.empty())
      out += fmt::format(" -x -a {}", fish_quoted(fmt::format("{}", fmt::join(option.words, " "))));
    else if (!option.value.empty())
      out += " -x";
    out += fmt::format(" -d {}\n", fish_quoted(option.help));
  }
  return out;
}

}  // namespace

std::string fish_completion(const CommandInfo& program) {
  std::vector<std::string> names;
  std::string rules;
  for (const FlatCommand& command : flatten(program)) {
    for (const CommandInfo* below : command.below) names.push_back(fish_quoted(below->name));
    rules += completions(program.name, command);
  }
  return fmt::format(R"(# Completion of {0} for fish, made from its command line.
function __{0}_is -d 'Whether the words so far name a command'
    set -l command {0}
    for word in (commandline -opc)[2..]
        contains -- "$command $word" {1}
        and set command "$command $word"
    end
    test "$command" = "$argv"
end

complete -c {0} -f
{2})",
                     program.name, fmt::join(names, " "), rules);
}

}  // namespace hypotrack::app
