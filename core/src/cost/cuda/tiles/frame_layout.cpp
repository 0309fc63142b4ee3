#include <fmt/format.h>

#include <algorithm>

#include "cost/cuda/tiles/tile_upload.hpp"
#include "cost/draw/hypothesis_drawer.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/view_pixels.hpp"

namespace hypotrack::cuda::internal {

FrameLayout frame_layout(const Observation& observation, const BandEnds& bands) {
  const std::size_t views = observation.views.size();
  if (views > kMaxViews) {
    throw DeviceError(fmt::format(
        "evaluate.backend: cuda: frame {} has {} views, at most {} can be evaluated on the GPU; "
        "write `backend: cpu`",
        observation.frame, views, kMaxViews));
  }
  const FrameProjection projection(observation);
  FrameLayout frame{};
  frame.view_count = static_cast<int>(views);
  frame.pair = projection.pair ? 1 : 0;
  for (std::size_t i = 0; i < views; ++i) {
    const ViewProjection& from = projection.views[i];
    ViewLayout& to = frame.views[i];
    std::copy(std::begin(from.camera_from_first), std::end(from.camera_from_first),
              to.view_from_first);
    to.fx = from.fx;
    to.fy = from.fy;
    to.cx = from.cx;
    to.cy = from.cy;
    to.width = from.width;
    to.height = from.height;
  }
  Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>(frame.first_from_world) =
      projection.first_from_world.matrix().topRows<3>().cast<float>();
  if (views >= 2) {
    frame.maps[0] = stereo_map(observation, 0, 1);
    frame.maps[1] = stereo_map(observation, 1, 0);
  }
  std::ranges::copy(bands, frame.work_ends);
  return frame;
}

}  // namespace hypotrack::cuda::internal
