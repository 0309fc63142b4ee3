#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "hypotrack/api/export.hpp"

namespace hypotrack {

/// Base of the interfaces of plugins: remembers how messages name the object.
///
/// Public functions of an interface check the answers of the plugin's `do_` functions. They name
/// the object in what it throws and where it crashes. An object without a label is checked alike,
/// and its exceptions pass through unchanged: the plugin that made it adds its own label.
class HYPOTRACK_API PluginObject {
 public:
  PluginObject(const PluginObject&) = delete;
  PluginObject& operator=(const PluginObject&) = delete;

  /// Sets how messages name the object, before other calls. `name`: its place in the scene, kind
  /// and name. `library`: the file of its class; empty: unknown.
  void set_label(std::string name, const std::string& library = {});
  /// Returns name and library; empty: none was set.
  const std::string& label() const { return label_; }
  /// Returns the name without the library; empty: none was set.
  const std::string& short_label() const { return short_label_; }
  /// Returns whether its Errors are complete messages, as those of a plugin that comes with
  /// hypotrack.
  bool explains() const { return explains_; }

 protected:
  PluginObject() = default;
  virtual ~PluginObject();

 private:
  std::string label_, short_label_;
  bool explains_ = false;
};

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
