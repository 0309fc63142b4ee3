#include "depth_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>

#include "test_models.hpp"

namespace hypotrack::rgbd_depth {

const Scene& box_scene() {
  static const Scene scene({{"box", std::make_shared<const Model>(test::make_test_box())}});
  return scene;
}

Eigen::VectorXd box_state() {
  Eigen::VectorXd state = box_scene().rest_state();
  state[2] = 0.5;
  return state;
}

TileView blank_view(int size) {
  TileView view;
  view.camera = {size, size, 100, 100, size / 2.0, size / 2.0, Eigen::Isometry3d::Identity()};
  view.valid = cv::Mat1b(size, size, uchar{255});
  view.depth = cv::Mat1f(size, size, 0.0f);
  return view;
}

Observation blank_observation(int size) {
  Observation observation;
  observation.scene = &box_scene();
  observation.start = box_state();
  observation.views.push_back(blank_view(size));
  return observation;
}

cv::Mat1f image(const Grid& depth) { return cv::Mat1f(depth, true).reshape(1, 4); }

Drawn::Drawn(const std::vector<Grid>& views, int size, int beyond)
    : state_(box_scene().parameters().size()) {
  const int stride = size + beyond;
  for (const Grid& grid : views) {
    auto& memory = memory_.emplace_back(static_cast<std::size_t>(stride) * size,
                                        std::numeric_limits<float>::quiet_NaN());
    DepthTile tile{size, size, stride, memory.data(), size, size, 0, 0};
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const float z = grid[static_cast<std::size_t>(y * size + x)];
        memory[static_cast<std::size_t>(y * stride + x)] = z > 0 ? 1 / z : 0.0f;
        if (!(z > 0)) continue;
        tile.x0 = std::min(tile.x0, x);
        tile.y0 = std::min(tile.y0, y);
        tile.x1 = std::max(tile.x1, x + 1);
        tile.y1 = std::max(tile.y1, y + 1);
      }
    }
    if (tile.x1 == 0) tile.x0 = tile.y0 = 0;
    tiles_.push_back(tile);
  }
}

}  // namespace hypotrack::rgbd_depth
