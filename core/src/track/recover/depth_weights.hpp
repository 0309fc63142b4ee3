#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/exported.hpp"
#include "base/stop_scope.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Tells surfaces in a range of depths from others, by the correlation of both pictures over
/// planes. Source: Collins, "A space-sweep approach to true multi-image matching", CVPR 1996.
class DepthWeights {
 public:
  /// `reductions` are the integer factors by which the pictures are reduced. The range is of depths
  /// from the first camera, metres.
  DepthWeights(const std::vector<Camera>& cameras, std::array<int, 2> reductions, double nearest,
               double farthest);

  /// Returns for each pixel of both reduced pictures the probability that its surface is in the
  /// range. Where both views are uniform it is about the range's share of all planes.
  std::array<cv::Mat1f, 2> weights(const std::array<cv::Mat3b, 2>& pictures);

 private:
  /// Pixels of the other picture that show the plane at some depth, for each pixel of one picture.
  struct Plane {
    bool in_range;
    cv::Mat2f other;
  };
  void make_planes(std::size_t view, const cv::Size& size, const StopCheck& stop);

  std::vector<Camera> cameras_;
  std::array<int, 2> reductions_;
  double nearest_, farthest_;
  std::array<std::vector<Plane>, 2> planes_;  ///< by view, made at the first use
};

}  // namespace internal
}  // namespace hypotrack
