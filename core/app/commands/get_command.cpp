#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "doctor/check.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack::app {
namespace {

/// Becomes the script that gets the detector's networks. Returns only by throwing DataError.
void get_detector(const std::filesystem::path& archive, const std::filesystem::path& folder) {
  std::vector<std::string> words = {data_file("hand_detector/get.sh").string()};
  if (!archive.empty()) {
    words.push_back("--archive");
    words.push_back(std::filesystem::absolute(archive).string());
  }
  if (!folder.empty()) words.push_back(std::filesystem::absolute(folder).string());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::fflush(nullptr);
  execv(arguments.front(), arguments.data());
  throw DataError(fmt::format("{} cannot be run: {}; {}", words.front(),
                              std::generic_category().message(errno), doctor::kInstallCompletely));
}

}  // namespace

void add_get_command(const Command& root) {
  const Command command = root.add_command("get", "Get what hypotrack does not contain");
  command.need_command();
  auto archive = std::make_shared<std::filesystem::path>();
  auto folder = std::make_shared<std::filesystem::path>();
  const Command detector = command.add_command(
      "detector", "Download the hand detector's networks, MediaPipe's, and check their hashes");
  detector.add("folder", folder.get(),
               "Folder to put them into (default: hypotrack/hand_detector in $XDG_DATA_HOME or "
               "~/.local/share)",
               {.check = file_name()});
  detector.add("--archive", archive.get(),
               "Take this file, which another machine downloaded, in place of the network",
               {.check = file_name()});
  detector.on_call([=] { get_detector(*archive, *folder); });
}

}  // namespace hypotrack::app
