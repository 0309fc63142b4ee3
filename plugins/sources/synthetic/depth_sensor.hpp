#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "params.hpp"

namespace hypotrack::synthetic {

/// What a depth camera does to depth: noise and steps.
class DepthSensor {
 public:
  explicit DepthSensor(const SensorParams& params);

  /// Changes depth in place: 32-bit float metres, 0: not measured, which stays. The noise is a
  /// function of seed, frame and camera alone.
  void apply(cv::Mat& depth, int frame, std::size_t camera) const;

 private:
  SensorParams params_;
  std::vector<float> noise_;  // samples of sigma 1 to take stretches from
};

}  // namespace hypotrack::synthetic
