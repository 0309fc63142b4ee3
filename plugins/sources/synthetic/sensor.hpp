#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "params.hpp"

namespace hypotrack::synthetic {

/// Simulates the cameras' optics and electronics: blur, gain and offset, noise.
class Sensor {
 public:
  /// Throws ConfigError, naming `where`, unless gain and offset have no number or one per camera.
  Sensor(const SensorParams& params, std::size_t cameras, const std::string& where);

  /// Changes an 8-bit BGR image in place. The noise depends on seed, frame and camera only.
  void apply(cv::Mat& image, int frame, std::size_t camera) const;

 private:
  void add_noise(cv::Mat& image, int frame, std::size_t camera) const;

  SensorParams params_;
  std::vector<std::int8_t> noise_;  // samples from which stretches are taken, as drawing each anew
                                    // is slow
};

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
