#pragma once

#include <vector>

#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/objective.hpp"

namespace hypotrack::rgbd_depth {

/// A box of 60 x 40 x 120 mm, which has no fingers, and where it stands: 0.44 m .. 0.56 m away.
const Scene& box_scene();
Eigen::VectorXd box_state();

/// A tile of `size` x `size` with depth around the box; every pixel valid, none measured.
TileView blank_view(int size);
/// One such view of the box.
Observation blank_observation(int size);

/// A 4x4 depth image or drawn hypothesis, row by row: metres, 0 for nothing.
using Grid = std::vector<float>;
cv::Mat1f image(const Grid& depth);

/// A hypothesis by what it draws, one grid per view. Rows are `beyond` floats longer than the tile;
/// those are NaN.
class Drawn {
 public:
  explicit Drawn(const std::vector<Grid>& views, int size = 4, int beyond = 0);
  RenderedHypothesis hypothesis() const { return {state_, tiles_}; }
  const DepthTile& tile(std::size_t view) const { return tiles_[view]; }

 private:
  std::vector<double> state_;
  std::vector<std::vector<float>> memory_;
  std::vector<DepthTile> tiles_;
};

}  // namespace hypotrack::rgbd_depth
