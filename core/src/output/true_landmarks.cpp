#include "output/true_landmarks.hpp"

namespace hypotrack {

std::optional<Eigen::Matrix3Xd> true_landmarks(const Scene& scene, const Frame& frame) {
  if (!frame.truth) return std::nullopt;
  if (frame.truth->landmarks.cols() > 0) return frame.truth->landmarks;
  if (frame.truth->state.size() > 0) return scene.landmarks(frame.truth->state);
  return std::nullopt;
}

}  // namespace hypotrack
