#include "depth_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "hypotrack/plugin/random.hpp"

namespace hypotrack::synthetic {
namespace {

constexpr std::size_t kDepthNoiseSamples = std::size_t{1} << 20;
constexpr std::uint32_t kStream = 1;  // 0 is the colour noise's

}  // namespace

DepthSensor::DepthSensor(const SensorParams& params) : params_(params) {
  if (params_.depth_noise <= 0) return;
  noise_.resize(kDepthNoiseSamples);
  cv::Mat samples(1, static_cast<int>(kDepthNoiseSamples), CV_32FC1, noise_.data());
  cv::RNG random(static_cast<std::uint64_t>(params_.seed) * 130363 + 7);
  random.fill(samples, cv::RNG::NORMAL, 0.0, 1.0);
}

void DepthSensor::apply(cv::Mat& depth, int frame, std::size_t camera) const {
  const auto sigma = static_cast<float>(params_.depth_noise);
  const auto step = static_cast<float>(params_.depth_step);
  if (noise_.empty() && step <= 0) return;
  for (int y = 0; y < depth.rows; ++y) {
    const RandomIndex index{static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(camera),
                            static_cast<std::uint32_t>(frame), kStream};
    const double place = uniform4(static_cast<std::uint64_t>(params_.seed), index)[0];
    const auto room =
        static_cast<double>(kDepthNoiseSamples - static_cast<std::size_t>(depth.cols));
    const float* noise = noise_.empty() ? nullptr : &noise_[static_cast<std::size_t>(place * room)];
    auto* row = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      float z = row[x];
      if (z <= 0) continue;
      if (noise) z += sigma * z * z * noise[x];
      if (step > 0) z = step * std::round(z / step);
      row[x] = std::max(z, 0.0F);
    }
  }
}

}  // namespace hypotrack::synthetic
