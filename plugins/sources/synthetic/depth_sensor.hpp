#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "params.hpp"

namespace hypotrack::synthetic {

/// Simulates a depth camera's noise and quantisation.
class DepthSensor {
 public:
  explicit DepthSensor(const SensorParams& params);

  /// Changes depth in place: 32-bit float metres; 0, not measured, stays. The noise depends on
  /// seed, frame and camera only.
  void apply(cv::Mat& depth, int frame, std::size_t camera) const;

 private:
  SensorParams params_;
  std::vector<float> noise_;  // samples of sigma 1, from which stretches are taken
};

}  // namespace hypotrack::synthetic
