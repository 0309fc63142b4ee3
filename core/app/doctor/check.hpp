#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

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

}  // namespace hypotrack::doctor
