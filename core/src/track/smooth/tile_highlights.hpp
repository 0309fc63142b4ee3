#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "base/exported.hpp"
#include "track/color/color_samples.hpp"
#include "track/color/highlights.hpp"
#include "track/smooth/lag_window.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Removes highlights from the tiles of a window's frames. Learns them from all frames together: a
/// pose that follows its own highlights contradicts frames with other poses.
class TileHighlights {
 public:
  /// The scene must outlive it.
  explicit TileHighlights(const Scene& scene) : sampler_(scene) {}

  /// Relearns the highlights from tiles that still have them, and the scene's states in those
  /// frames (one per tile set). The former strengths only decide which samples are outliers.
  void learn(const std::vector<FrameTiles>& tiles, const std::vector<TimedState>& states);

  /// Returns the tiles without highlights, for the scene in a normalised state.
  Observation off(const Observation& tiles, const Eigen::VectorXd& state);

 private:
  ColorSampler sampler_;
  std::vector<Highlights> views_;  // without the first
};

}  // namespace internal
}  // namespace hypotrack
