#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// What a plugin told the user.
struct PluginNote {
  bool warning = false;
  std::string who;           ///< `objective.1 (edges)`
  std::optional<int> frame;  ///< that was tracked when it was told first
  std::string text;
  std::int64_t count = 0;  ///< how often it was told
};

/// Collects what the plugins of one scene tell the user. May be used from several threads at once.
class PluginNotes {
 public:
  /// Number of different texts of one plugin; further ones count as one.
  static constexpr std::size_t kMostTexts = 20;

  /// Takes a text. Adds the frame that the calling thread or, without one, the program works on.
  void add(const std::string& who, bool warning, std::string_view text);

  /// Returns a line for each note since the last call: `note: objective (edges), frame 12: ...`.
  std::vector<std::string> take_lines();
  /// Returns a line for each note that was told more than once.
  std::vector<std::string> repeated_lines() const;
  /// Returns all notes, in the order in which they were told first.
  std::vector<PluginNote> all() const;

 private:
  mutable std::mutex mutex_;  ///< guards all below
  std::vector<PluginNote> notes_;
  std::size_t told_ = 0;  ///< notes that take_lines() has returned
  std::map<std::string, std::map<std::string, std::size_t, std::less<>>>
      indices_;  ///< of notes, by plugin and text
};

}  // namespace internal
}  // namespace hypotrack
