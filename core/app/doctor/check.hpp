#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hypotrack::doctor {

enum class State { ok, missing, broken };

/// Returns the state as a word.
constexpr std::string_view word_of(State state) {
  constexpr std::array<std::string_view, 3> kWords = {"ok", "missing", "broken"};
  return kWords[static_cast<std::size_t>(state)];
}

/// One line of `hypotrack doctor`.
struct Check {
  std::string name = {};
  State state = State::ok;
  bool needed = false;     ///< by every run; a problem then fails the command
  std::string found = {};  ///< may have several lines
  std::string fix = {};    ///< command or advice; empty if nothing is wrong
};

/// Remedy for a missing part of hypotrack itself.
inline constexpr const char* kInstallCompletely = "build or install hypotrack completely";

/// Lists video devices with their names. `devices` is /dev, `classes` /sys/class/video4linux.
Check check_cameras(const std::filesystem::path& devices, const std::filesystem::path& classes);

/// Checks the plugin folders and opens every plugin in a child process.
std::vector<Check> check_plugins(std::span<const std::filesystem::path> extra_folders);

/// Returns true if nothing is wrong with what every run needs.
bool is_ready(std::span<const Check> checks);

/// Formats a line per check, with a remedy below each problem, and a conclusion.
std::string text_of(std::span<const Check> checks);

/// Formats the checks as JSON: `ready`, and per check its name, state, needed, found and fix.
std::string json_of(std::span<const Check> checks);

}  // namespace hypotrack::doctor
