#pragma once

#include <string>
#include <vector>

#include "command_info.hpp"

namespace hypotrack::app {

/// A command with all options that it takes, and the names of the commands below it.
struct FlatCommand {
  std::string name;  ///< `hypotrack plugins info`
  std::string summary;
  std::vector<OptionInfo> options;        ///< those of the program with a value included
  std::vector<const CommandInfo*> below;  ///< commands below it
};

/// Lists a program's commands from the top down. `program` must outlive the list.
std::vector<FlatCommand> flatten(const CommandInfo& program);

/// Returns the last word of a command's name.
std::string last_word(const std::string& name);

/// Replaces every `from` in a text.
std::string replace_all(std::string text, const std::string& from, const std::string& to);

// Completions for three shells.
std::string bash_completion(const CommandInfo& program);
std::string zsh_completion(const CommandInfo& program);
std::string fish_completion(const CommandInfo& program);

/// A manual page and the name of its file.
struct ManPage {
  std::string file;  ///< hypotrack-run.1
  std::string text;  ///< for man's macros
};

/// Writes a page per command.
std::vector<ManPage> man_pages(const CommandInfo& program, const std::string& version);

}  // namespace hypotrack::app
