#include <regex>

#include "app_test.hpp"

namespace hypotrack::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A command of the program as its help shows it.
struct HelpedCommand {
  std::vector<std::string> words;    ///< plugins, info
  std::vector<std::string> options;  ///< --markdown
};

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string out = "hypotrack";
  for (const std::string& word : words) out += between + word;
  return out;
}

/// Lists the commands by their help, from the top down.
std::vector<HelpedCommand> commands_below(const std::vector<std::string>& words) {
  std::vector<std::string> arguments = words;
  arguments.emplace_back("--help");
  std::vector<HelpedCommand> out{{words, {}}};
  std::vector<std::string> below;
  bool in_commands = false;
  for (const std::string& line : lines_of(run_program(arguments).out)) {
    in_commands = line == "Subcommands:" || (in_commands && !line.empty());
    std::smatch found;
    if (in_commands && std::regex_search(line, found, std::regex("^  ([a-z-]+) ")))
      below.push_back(found[1]);
    if (!in_commands && std::regex_search(line, found, std::regex("^  (?:-[a-z],)?(--[a-z-]+)")))
      out.front().options.push_back(found[1]);
  }
  for (const std::string& name : below) {
    std::vector<std::string> longer = words;
    longer.push_back(name);
    const std::vector<HelpedCommand> more = commands_below(longer);
    out.insert(out.end(), more.begin(), more.end());
  }
  return out;
}

std::filesystem::path share(const std::string& name) { return build_dir() / "share" / name; }

class ShellFilesTest : public AppTest {
 protected:
  static std::filesystem::path bash() { return share("bash-completion/completions/hypotrack"); }
  static std::filesystem::path zsh() { return share("zsh/site-functions/_hypotrack"); }
  static std::filesystem::path fish() { return share("fish/vendor_completions.d/hypotrack.fish"); }

  /// Runs a shell in the test's folder and returns the lines that it prints.
  std::vector<std::string> shell(const std::string& program, const std::string& script) const {
    const Captured captured =
        capture_output({program, {"-c", script}, {"HOME=" + folder().string()}, folder()}, {1, 2},
                       {std::chrono::seconds(60)});
    EXPECT_EQ(captured.end.code, 0) << captured.output;
    return lines_of(captured.output);
  }

  /// Completes the last word of a command line in bash.
  std::vector<std::string> in_bash(const std::string& words) const {
    return shell("/bin/bash",
                 "source " + bash().string() + "\nCOMP_WORDS=(" + words +
                     ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_hypotrack\n"
                     "[[ ${#COMPREPLY[@]} = 0 ]] || printf '%s\\n' \"${COMPREPLY[@]}\"");
  }
};

TEST_F(ShellFilesTest, EveryCommandAndOptionIsInTheCompletionsAndManualPages) {
  const std::vector<HelpedCommand> commands = commands_below({});
  ASSERT_GT(commands.size(), 12u);
  const std::string for_bash = read_text(bash()), for_zsh = read_text(zsh()),
                    for_fish = read_text(fish());
  for (const HelpedCommand& command : commands) {
    const std::string name = joined(command.words, " ");
    SCOPED_TRACE(name);
    const std::string page = read_text(share("man/man1/" + joined(command.words, "-") + ".1"));
    EXPECT_THAT(for_bash, HasSubstr("\"" + name + " \")"));
    EXPECT_THAT(for_fish, HasSubstr("is \"" + name + "\"'"));
    const std::string function =
        "\n_" + std::regex_replace(joined(command.words, "_"), std::regex("-"), "_") + "() {";
    ASSERT_THAT(for_zsh, HasSubstr(function));
    const std::size_t begin = for_zsh.find(function) + 1;
    const std::string in_zsh = for_zsh.substr(begin, for_zsh.find("\n}\n", begin) - begin);
    const std::size_t at = for_bash.find("\"" + name + " \")");
    const std::string case_of_bash = for_bash.substr(at, for_bash.find(";;", at) - at);
    EXPECT_THAT(command.options, testing::Contains("--help"));
    for (const std::string& option : command.options) {
      EXPECT_THAT(case_of_bash, testing::ContainsRegex(option + "[ \"]"));
      EXPECT_THAT(in_zsh, HasSubstr(option));
      EXPECT_THAT(for_fish, HasSubstr("is \"" + name + "\"' -l " + option.substr(2) + " "));
      EXPECT_THAT(page, HasSubstr("\\fB" + std::regex_replace(option, std::regex("-"), "\\-")));
    }
  }
}

TEST_F(ShellFilesTest, HiddenCommandsAreNotInThem) {
  const std::string hidden = "write-shell-files";
  EXPECT_EQ(run_program({hidden, path("share").string()}).exit_code, 0);
  EXPECT_EQ(read_text(path("share/zsh/site-functions/_hypotrack")), read_text(zsh()));
  for (const std::string& text : {read_text(bash()), read_text(zsh()), read_text(fish()),
                                  run_program({"--help"}).out, run_program({"writ"}).err})
    EXPECT_THAT(text, testing::Not(HasSubstr(hidden)));
}

TEST_F(ShellFilesTest, BashCompletesCommandsOptionsAndValues) {
  write_text(path("my scene.yaml"), "");
  EXPECT_THAT(in_bash("hypotrack va"), ElementsAre("validate"));
  EXPECT_THAT(in_bash("hypotrack plugins ''"),
              ElementsAre("list", "info", "capabilities", "measures", "new", "check"));
  EXPECT_THAT(in_bash("hypotrack run --fr"), ElementsAre("--frames"));
  EXPECT_THAT(in_bash("hypotrack evaluate --units ''"), ElementsAre("m", "cm", "mm"));
  EXPECT_THAT(in_bash("hypotrack new scene a.yaml --tracker real"),
              ElementsAre("real", "real_time"));
  EXPECT_THAT(in_bash("hypotrack run my"), ElementsAre("my scene.yaml"));
  EXPECT_THAT(in_bash("hypotrack run --frames ''"), ElementsAre());
}

TEST_F(ShellFilesTest, BashTakesValuesOfOptionsForNoCommands) {
  EXPECT_THAT(in_bash("hypotrack --plugin-path plugins va"), ElementsAre("validate"));
  EXPECT_THAT(in_bash("hypotrack run --out plugins --se"), ElementsAre("--set", "--seed"));
}

TEST_F(ShellFilesTest, ZshCompletesCommandsAndOptions) {
  const std::string program = "/usr/bin/zsh";
  if (!std::filesystem::exists(program)) GTEST_SKIP() << "needs zsh";
  // A shell at a terminal, where `hypotrack` prints its arguments.
  const auto completed = [&](const std::string& line) {
    const std::vector<std::string> lines = shell(
        program,
        "zmodload zsh/zpty\nzpty z 'zsh -f -i'\n"
        "zpty -w z 'PS1=; fpath=(" +
            zsh().parent_path().string() +
            " $fpath); "
            "autoload -Uz compinit; compinit -u -D; hypotrack() { print F\"\"OUND\"[$*]\" }'\n"
            "zpty -w z $'" +
            line + "'\nzpty -r -m z out '*FOUND\\[*\\]*'\nprint -r -- $out\nzpty -d z");
    for (const std::string& text : lines)
      if (std::smatch found; std::regex_search(text, found, std::regex("FOUND\\[(.*)\\]")))
        return found[1].str();
    return std::string();
  };
  EXPECT_EQ(completed("hypotrack eval\\t"), "evaluate");
  EXPECT_EQ(completed("hypotrack plugins inf\\t pso --mar\\t"), "plugins info pso --markdown");
  EXPECT_EQ(completed("hypotrack run --fra\\t"), "run --frames");
  EXPECT_EQ(completed("hypotrack new scene a.yaml --model two\\t"),
            "new scene a.yaml --model two_hands");
}

TEST_F(ShellFilesTest, FishCompletesCommandsAndOptions) {
  const std::string program = "/usr/bin/fish";
  if (!std::filesystem::exists(program)) GTEST_SKIP() << "needs fish";
  const auto completed = [&](const std::string& line) {
    std::vector<std::string> words =
        shell(program, "source " + fish().string() + "\ncomplete -C '" + line + "'");
    for (std::string& word : words) word = word.substr(0, word.find('\t'));
    return words;
  };
  EXPECT_THAT(completed("hypotrack eval"), ElementsAre("evaluate"));
  EXPECT_THAT(completed("hypotrack plugins "),
              ElementsAre("capabilities", "check", "info", "list", "measures", "new"));
  EXPECT_THAT(completed("hypotrack run --fra"), ElementsAre("--frames"));
  EXPECT_THAT(completed("hypotrack new scene a.yaml --model two"), ElementsAre("two_hands"));
}

TEST_F(ShellFilesTest, ManFormatsThePagesWithoutAWarning) {
  const std::string program = "/usr/bin/man";
  if (!std::filesystem::exists(program)) GTEST_SKIP() << "needs man (Debian: man-db)";
  const std::string text = read_text(share("man/man1/hypotrack-run.1"));
  ASSERT_THAT(text, HasSubstr("Track a scene"));
  EXPECT_THAT(shell("/bin/sh", "for page in " + share("man/man1").string() +
                                   "/*.1; do man --warnings=w -E UTF-8 -l -Tutf8 \"$page\" "
                                   ">/dev/null; done"),
              ElementsAre());
}

}  // namespace
}  // namespace hypotrack::test
