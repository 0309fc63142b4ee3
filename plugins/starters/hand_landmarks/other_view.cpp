#include "other_view.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hand_pairs.hpp"
#include "hypotrack/api/camera.hpp"

namespace hypotrack::hands {
namespace {

/// Returns the landmarks in the world of a hand that is `size` times as large as an average one.
HandPoints3D in_world(const Camera& camera, const HandDetection& hand, double size) {
  const HandPoints3D rays = back_project(camera, hand.landmarks);
  const auto spread = [](const HandPoints& points) {
    return std::sqrt((points.colwise() - points.rowwise().mean()).squaredNorm());
  };
  const double depth = size * spread(hand.relative.topRows<2>()) / spread(rays.topRows<2>());
  HandPoints3D out;
  for (Eigen::Index i = 0; i < out.cols(); ++i)
    out.col(i) = rays.col(i) * (depth + size * hand.relative(2, i));
  return camera.camera_from_world.inverse() * out;
}

HandPoints projected(const Camera& camera, const HandPoints3D& landmarks) {
  HandPoints out;
  for (Eigen::Index i = 0; i < out.cols(); ++i) out.col(i) = project(camera, landmarks.col(i));
  return out;
}

}  // namespace

void look_in_other_view(const HandDetector& detector, const std::array<Camera, 2>& cameras,
                        const std::vector<HandDetection>& seen, std::size_t view,
                        const cv::Mat& other_picture, std::vector<HandDetection>& known) {
  const std::vector<HandDetection> there = known;
  for (const HandDetection& hand : seen) {
    const auto pairs_with = [&](const std::vector<HandDetection>& others) {
      const std::vector<HandDetection> one{hand};
      return !(view == 0 ? pair_hands(cameras, one, others) : pair_hands(cameras, others, one))
                  .empty();
    };
    if (pairs_with(there)) continue;
    for (const double size : {1.0, 0.85, 1.18}) {
      const std::optional<HandDetection> other = detector.refine(
          other_picture, projected(cameras[1 - view], in_world(cameras[view], hand, size)));
      if (!other || !pairs_with({*other})) continue;
      known.push_back(*other);
      break;
    }
  }
}

}  // namespace hypotrack::hands
