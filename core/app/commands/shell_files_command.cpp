#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "base/text_file.hpp"
#include "commands.hpp"
#include "shell/shell_files.hpp"

namespace hypotrack::app {
namespace {

void write_into(const std::filesystem::path& folder, const std::string& name,
                const std::string& text) {
  std::error_code ignored;  // write_whole() says what cannot be written
  std::filesystem::create_directories(folder, ignored);
  write_whole(folder / name, text);
}

/// Writes completions and manual pages where shells and man look for them below `share`.
void write_shell_files(const CommandInfo& program, const std::filesystem::path& share) {
  write_into(share / "bash-completion/completions", program.name, bash_completion(program));
  write_into(share / "zsh/site-functions", "_" + program.name, zsh_completion(program));
  write_into(share / "fish/vendor_completions.d", program.name + ".fish", fish_completion(program));
  for (const ManPage& page : man_pages(program, HYPOTRACK_VERSION))
    write_into(share / "man/man1", page.file, page.text);
}

}  // namespace

void add_shell_files_command(CommandLine& line) {
  auto share = std::make_shared<std::filesystem::path>();
  const Command command = line.root().add_command(
      "write-shell-files", "Write shell completions and manual pages, for installations");
  command.hide();
  command.add("share", share.get(), "Folder such as /usr/share", {.required = true});
  command.on_call([=, &line] { write_shell_files(line.info(), *share); });
}

}  // namespace hypotrack::app
