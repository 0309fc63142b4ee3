#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/text_file.hpp"
#include "commands.hpp"
#include "config/former_keys.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack::app {
namespace {

/// Rewrites all files, or none if one of them cannot be.
void migrate_files(const std::vector<std::filesystem::path>& files) {
  std::vector<std::pair<std::filesystem::path, std::string>> changed;
  for (const auto& file : files) {
    const auto text = read_whole(file);
    if (!text) throw ConfigError(fmt::format("{}: cannot be read", file.string()));
    std::string now = detail::migrate(*text, file.string());
    if (now == *text)
      fmt::print("{}: has no former key\n", file.string());
    else
      changed.emplace_back(file, std::move(now));
  }
  for (const auto& [file, text] : changed)
    if (access(file.c_str(), W_OK) != 0)
      throw OutputError(
          fmt::format("{}: is write-protected; no file was rewritten", file.string()));
  for (const auto& [file, text] : changed) {
    const auto permissions = std::filesystem::status(file).permissions();
    write_whole(file, text);
    std::filesystem::permissions(file, permissions);
    fmt::print("{}: rewritten\n", file.string());
  }
}

}  // namespace

void add_migrate_command(const Command& root) {
  auto files = std::make_shared<std::vector<std::filesystem::path>>();
  const Command command =
      root.add_command("migrate", "Rewrite former keys in scenes, tracker files and studies");
  command.add("files", files.get(), "Files to rewrite; comments stay", {.required = true});
  command.on_call([files] { migrate_files(*files); });
}

}  // namespace hypotrack::app
