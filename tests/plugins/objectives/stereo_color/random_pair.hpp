#pragma once

#include <cstdint>
#include <vector>

#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::stereo_color {

/// What a made-up stereo pair looks like.
struct PairOptions {
  bool rectified = true;
  bool mask = false;
  int size = 128;
  int stride_beyond = 0;  ///< floats per depth row beyond the width, filled with NaN
  std::uint32_t seed = 1;
};

/// An observation and one hypothesis of it. The hypothesis covers an ellipse with holes, at depths
/// about 0.5 m; most of its points reappear in the other view, some a few millimetres off, some not
/// at all; the colours there are those of the first view with noise. A margin of the images is
/// invalid.
struct RandomPair {
  explicit RandomPair(const PairOptions& options);
  RandomPair(const RandomPair&) = delete;
  RandomPair& operator=(const RandomPair&) = delete;

  Observation observation;
  std::vector<float> depth[2];
  DepthTile tiles[2];
  RenderedHypothesis hypothesis() const { return {{}, tiles}; }
};

}  // namespace hypotrack::stereo_color
