#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "hypotrack/export.hpp"
#include "track/color/color_samples.hpp"
#include "track/color/highlights.hpp"
#include "track/smooth/sight.hpp"

namespace hypotrack {

/// Takes highlights off the tiles of a window's frames by what all of them show: what a frame's
/// pose has turned by its highlights, frames with other poses tell.
class HYPOTRACK_API TileHighlights {
 public:
  /// The scene must outlive it.
  explicit TileHighlights(const Scene& scene) : sampler_(scene) {}

  /// Learns anew from tiles with their highlights, of which there are as many as moments, where the
  /// scene is as in those. What was known before decides only which differences are far off.
  void learn(const std::vector<Sight>& sights, const std::vector<Moment>& moments);

  /// Tiles without highlights, if the scene is about as in a normalised state.
  Observation off(const Observation& tiles, const Eigen::VectorXd& state);

 private:
  ColorSampler sampler_;
  std::vector<Highlights> views_;  // but for the first
};

}  // namespace hypotrack
