#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "params.hpp"

namespace hypotrack::synthetic {

/// What the cameras' electronics and optics do to a picture: blur, gain and offset, noise.
class Sensor {
 public:
  /// Throws ConfigError, naming `where`, unless gain and offset have no number or one per camera.
  Sensor(const SensorParams& params, std::size_t cameras, const std::string& where);

  /// Changes an 8-bit BGR image in place; the noise is a function of seed, frame and camera alone.
  void apply(cv::Mat& image, int frame, std::size_t camera) const;

 private:
  void add_noise(cv::Mat& image, int frame, std::size_t camera) const;

  SensorParams params_;
  std::vector<std::int8_t> noise_;  // samples to take stretches from: drawing each anew takes long
};

}  // namespace hypotrack::synthetic
