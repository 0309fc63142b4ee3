#pragma once

#include <string>
#include <vector>

#include "hypotrack/export.hpp"
#include "hypotrack/frame.hpp"
#include "hypotrack/plugin.hpp"
#include "lab/bench/bench_plan.hpp"

namespace hypotrack::bench {

/// Frames in memory, kept for as long as the cases that follow have the same source.
class HYPOTRACK_API Frames {
 public:
  /// `usable` frames are read of each source, or as many as it has; those that cannot be used and
  /// lie between them are read, too.
  Frames(PluginLoader& plugins, int usable) : plugins_(&plugins), usable_(usable) {}

  /// The frames of a case from the first that can be used; valid until the next call. Throws what
  /// is wrong with the scene, DataError if it has no such frame.
  std::vector<Frame>& of(const Case& c);

 private:
  PluginLoader* plugins_;
  int usable_;
  std::string source_;  ///< what frames_ were read from
  std::vector<Frame> frames_;
};

/// Copies what lies elsewhere than images are made now to where they are: opening a scene that is
/// evaluated on a GPU changes that.
HYPOTRACK_API void renew_images(std::vector<Frame>& frames);

}  // namespace hypotrack::bench
