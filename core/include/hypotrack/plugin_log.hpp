#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "hypotrack/export.hpp"

namespace hypotrack {

inline namespace [[gnu::visibility("default")]] internal {  // for hypotrack's own programs
class PluginNotes;
}

/// Takes what a plugin has to tell the user. Copies tell the same run. All functions may be called
/// from several threads at once.
///
/// Each text is shown once, with the plugin's place in the scene and the frame that is tracked:
/// `objective.1 (edges), frame 12: ...`. Repeated texts are counted in summary.json. Keep numbers
/// that change out of the text: after 20 different ones, further texts are only counted.
class HYPOTRACK_API PluginLog {
 public:
  /// Makes a log that nobody reads.
  PluginLog() = default;
  /// `who`: the plugin's place in the scene and its name.
  PluginLog(std::shared_ptr<PluginNotes> notes, std::string who);

  /// Tells what is good to know: a substitute that was taken, a setting without effect.
  void note(std::string_view text) const;
  /// Tells what probably makes results worse.
  void warning(std::string_view text) const;
  /// Returns false if nobody reads the log, so that making a text may be left out.
  bool is_read() const { return notes_ != nullptr; }

 private:
  std::shared_ptr<PluginNotes> notes_;
  std::string who_;
};

}  // namespace hypotrack
