#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "command_info.hpp"

namespace CLI {
class App;
}

namespace hypotrack::app {

/// Where the value of an option goes. A bool is a flag without a value; a vector collects the
/// values of a repeated option.
using OptionTarget =
    std::variant<bool*, int*, double*, std::string*, std::filesystem::path*, std::optional<int>*,
                 std::optional<std::int64_t>*, std::optional<std::string>*,
                 std::optional<std::filesystem::path>*, std::vector<std::string>*,
                 std::vector<std::filesystem::path>*>;

/// Checks the text of a value. Returns what is wrong with it, with what is expected; empty if
/// nothing is.
struct OptionCheck {
  std::function<std::string(const std::string&)> problem = {};
  std::string hint = {};  ///< shown in the help beside the option's type
};
OptionCheck whole_number(std::int64_t lowest,
                         std::int64_t highest = std::numeric_limits<int>::max());
OptionCheck positive_number();
OptionCheck file_name();
OptionCheck existing_folder();
OptionCheck one_of(std::vector<std::string> words);

struct OptionRules {
  bool required = false;
  bool show_default = false;  ///< in the help
  OptionCheck check = {};
  std::string value_name = {};  ///< shown in the help; default: the name of the type
  std::string excludes = {};    ///< an option that may not be given with this one
  bool commas = false;          ///< one value may be a list with commas
  std::string if_bare = {};     ///< value of the option where it is given without one
  bool secret = false;          ///< lists of processes show neither option nor value
};

/// One command of the program: its options and its action. A handle that may be copied.
class Command {
 public:
  /// `secrets`: takes the names of the secret options.
  Command(CLI::App& app, std::vector<std::string>& secrets) : app_(&app), secrets_(&secrets) {}

  Command add_command(const std::string& name, const std::string& summary) const;
  /// Adds an option (`--name`) or an argument by position (`name`). The target must outlive the
  /// parsing.
  void add(const std::string& name, OptionTarget target, const std::string& help,
           const OptionRules& rules = {}) const;
  /// Leaves the command out of the help, completions and manual pages.
  void hide() const;
  /// Demands one of the commands below this one.
  void need_command() const;
  /// Accepts any further arguments and ignores them.
  void ignore_others() const;
  void on_call(std::function<void()> action) const;

 private:
  CLI::App* app_;
  std::vector<std::string>* secrets_;
};

/// The whole command line.
class CommandLine {
 public:
  CommandLine(const std::string& description, const std::string& version);
  ~CommandLine();

  Command root();
  /// Describes all commands that are not hidden.
  CommandInfo info() const;
  /// Parses and calls the command's action. Prints the help or a mistake. Returns the exit code of
  /// a mistake, 0 otherwise. Lets exceptions of the action through. Overwrites secret options in
  /// argv.
  int run(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
  std::vector<std::string> secrets_;  ///< names of options
};

}  // namespace hypotrack::app
