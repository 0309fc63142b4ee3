#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "shell/shell_files.hpp"

namespace hypotrack::app {
namespace {

/// Writes words as alternatives of a bash pattern.
std::string bash_pattern(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words)
    out += fmt::format("{}\"{}\"", out.empty() ? "" : " | ", word);
  return out;
}

/// Writes the case of a word that is not the value of an option.
std::string case_of_word(const FlatCommand& command) {
  std::vector<std::string> names, words;
  bool files = false;
  for (const OptionInfo& option : command.options) {
    if (!option.is_argument())
      names.push_back(option.name);
    else if (option.is_path)
      files = true;
  }
  for (const CommandInfo* below : command.below) words.push_back(last_word(below->name));
  const bool only_options = words.empty() && !files;
  std::string out = fmt::format("    \"{} \")\n", command.name);
  if (only_options) return out + fmt::format("      words=\"{}\" ;;\n", fmt::join(names, " "));
  out +=
      fmt::format("      if [[ $current == -* ]]; then words=\"{}\"; else words=\"{}\"{}; fi ;;\n",
                  fmt::join(names, " "), fmt::join(words, " "), files ? " files=1" : "");
  return out;
}

}  // namespace

std::string bash_completion(const CommandInfo& program) {
  std::vector<std::string> commands, with_value, with_path;
  std::string cases;
  for (const FlatCommand& command : flatten(program)) {
    for (const CommandInfo* below : command.below) commands.push_back(below->name);
    cases += case_of_word(command);
    for (const OptionInfo& option : command.options) {
      if (option.is_argument() || option.value.empty()) continue;
      const std::string name = command.name + " " + option.name;
      with_value.push_back(name);
      if (option.is_path) with_path.push_back(name);
      if (!option.words.empty())
        cases += fmt::format("    \"{}\") words=\"{}\" ;;\n", name, fmt::join(option.words, " "));
    }
  }
  return fmt::format(R"(# Completion of {0} for bash, made from its command line.
_{0}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} command="{0}" option="" words="" files="" word i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${{COMP_WORDS[i]}}
    if [[ -n $option ]]; then
      option=""
      continue
    fi
    case "$command $word" in
      {1}) command="$command $word" ;;
      {2}) option=$word ;;
    esac
  done
  case "$command $option" in
    {3}) files=1 ;;
{4}  esac
  mapfile -t COMPREPLY < <(
    compgen -W "$words" -- "$current"
    [[ -n $files ]] && compgen -f -- "$current"
  )
  [[ -n $files ]] && compopt -o filenames 2>/dev/null
  return 0
}}
complete -F _{0} {0}
)",
                     program.name, bash_pattern(commands), bash_pattern(with_value),
                     bash_pattern(with_path), cases);
}

}  // namespace hypotrack::app
