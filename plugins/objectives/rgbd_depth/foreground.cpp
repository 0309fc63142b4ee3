#include "foreground.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "hypotrack/kinematics.hpp"
#include "observed.hpp"

namespace hypotrack::rgbd_depth {
namespace {

// Non-zero where depth was measured within the range.
cv::Mat measured_within(const cv::Mat& depth, const DepthRange& range) {
  return (depth > 0) & (depth >= range.nearest) & (depth <= range.farthest);
}

cv::Mat foreground_of(const TileView& view, Foreground foreground, const DepthRange& range) {
  const bool masked = foreground == Foreground::automatic && !view.mask.empty();
  if (foreground == Foreground::mask || masked) return view.mask;
  const cv::Mat within = measured_within(view.depth, range);
  if (foreground != Foreground::skin) return within;
  const cv::Mat unmeasured = ~cv::Mat(view.depth > 0);
  return skin(view.color) & (within | unmeasured);
}

}  // namespace

DepthRange depth_range(const Scene& scene, const Eigen::VectorXd& state, const TileCamera& camera,
                       double margin) {
  const Eigen::RowVector3f axis = camera.camera_from_world.linear().row(2).cast<float>();
  const auto offset = camera.camera_from_world.translation().z();
  DepthRange range{std::numeric_limits<double>::infinity(), 0};
  for (const Scene::Item& item : scene.items()) {
    const Eigen::RowVectorXf z = axis * posed_vertices(*item.model, scene.part(item, state));
    range.nearest = std::min(range.nearest, offset + double{z.minCoeff()} - margin);
    range.farthest = std::max(range.farthest, offset + double{z.maxCoeff()} + margin);
  }
  return range;
}

cv::Mat skin(const cv::Mat& bgr) {
  cv::Mat ycrcb, out;
  cv::cvtColor(bgr, ycrcb, cv::COLOR_BGR2YCrCb);
  cv::inRange(ycrcb, cv::Scalar(0, 133, 77), cv::Scalar(255, 173, 127), out);
  return out;
}

ObservedView observe(const TileView& view, Foreground foreground, const DepthRange& range) {
  const cv::Mat front = foreground_of(view, foreground, range);
  ObservedView out;
  out.pixels.resize(view.depth.cols, view.depth.rows);
  for (int y = 0; y < view.depth.rows; ++y) {
    const auto* valid = view.valid.ptr<std::uint8_t>(y);
    const auto* in_front = front.ptr<std::uint8_t>(y);
    const auto* depth = view.depth.ptr<float>(y);
    float* observed = out.pixels.row(y);
    for (int x = 0; x < view.depth.cols; ++x) {
      if (!valid[x]) {
        observed[x] = kOutside;
      } else if (!in_front[x]) {
        observed[x] = kBackground;
      } else {
        const bool measured = depth[x] > 0;  // false for NaN
        observed[x] = measured ? depth[x] : kUnmeasured;
        out.measured += measured;
        ++out.foreground;
      }
    }
  }
  return out;
}

}  // namespace hypotrack::rgbd_depth
