#pragma once

#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/plugin.hpp"
#include "lab/bench/bench_plan.hpp"

namespace hypotrack::bench {
inline namespace HYPOTRACK_EXPORTED internal {

/// Frames in memory, kept while consecutive cases have the same source.
class Frames {
 public:
  /// Reads up to `usable` usable frames of each source, and the unusable ones between them.
  Frames(PluginLoader& plugins, int usable) : plugins_(&plugins), usable_(usable) {}

  /// Returns the frames of a case, starting with the first usable one; valid until the next call.
  /// Throws the errors of the scene, DataError if no frame is usable.
  std::vector<Frame>& of(const Case& c);

 private:
  PluginLoader* plugins_;
  int usable_;
  std::string source_;  ///< what frames_ were read from
  std::vector<Frame> frames_;
};

/// Copies images that are not in memory of OpenCV's present default allocator. Opening a scene that
/// is evaluated on a GPU changes that allocator.
void renew_images(std::vector<Frame>& frames);

}  // namespace internal
}  // namespace hypotrack::bench
