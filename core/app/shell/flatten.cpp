#include <algorithm>
#include <iterator>

#include "shell/shell_files.hpp"

namespace hypotrack::app {
namespace {

void add(const CommandInfo& command, const std::vector<OptionInfo>& inherited,
         std::vector<FlatCommand>& out) {
  FlatCommand flat{command.name, command.summary, command.options, {}};
  flat.options.insert(flat.options.end(), inherited.begin(), inherited.end());
  for (const CommandInfo& below : command.commands) flat.below.push_back(&below);
  out.push_back(std::move(flat));
  for (const CommandInfo& below : command.commands) add(below, inherited, out);
}

}  // namespace

std::vector<FlatCommand> flatten(const CommandInfo& program) {
  std::vector<OptionInfo> inherited;
  std::ranges::copy_if(program.options, std::back_inserter(inherited),
                       [](const OptionInfo& option) { return !option.value.empty(); });
  std::vector<FlatCommand> out;
  add(program, inherited, out);
  out.front().options = program.options;  // which has them already
  return out;
}

std::string last_word(const std::string& name) { return name.substr(name.rfind(' ') + 1); }

std::string replace_all(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace hypotrack::app
