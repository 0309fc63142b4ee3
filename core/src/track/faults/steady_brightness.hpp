#pragma once

#include <span>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/frame.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Takes jumps of brightness out of pictures: what was learned of colours stays true.
class SteadyBrightness {
 public:
  /// Takes by how much each view became brighter since the frame before; 1: no jump.
  void next(std::span<const float> jumps);

  /// Returns the last frame with its pictures as bright as before; the frame itself if they are.
  Frame applied_to(const Frame& frame) const;

 private:
  std::vector<float> gains_;  ///< of each view's pictures against what is searched
};

}  // namespace internal
}  // namespace hypotrack
