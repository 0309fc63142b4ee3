#pragma once

#include <string>
#include <vector>

namespace hypotrack::app {

/// An option (`--out`) or an argument by position (`scene`) of a command.
struct OptionInfo {
  std::string name;
  std::string short_name;  ///< `-h`; may be empty
  std::string value;       ///< what the help calls its value; empty: a flag
  std::string help;
  std::string default_value;       ///< empty: none is shown
  std::vector<std::string> words;  ///< the values that are allowed; empty: any
  bool is_path = false;
  bool required = false;
  bool repeats = false;

  bool is_argument() const { return !name.starts_with('-'); }
};

/// A command with its options and the commands below it.
struct CommandInfo {
  std::string name;  ///< with the commands above it: `hypotrack plugins info`
  std::string summary;
  std::vector<OptionInfo> options;  ///< its own, arguments included
  std::vector<CommandInfo> commands;
};

}  // namespace hypotrack::app
