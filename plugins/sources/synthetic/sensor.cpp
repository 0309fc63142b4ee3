#include "sensor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/random.hpp"

namespace hypotrack::synthetic {
namespace {

constexpr std::size_t kNoiseSamples = std::size_t{1} << 21;

void check_count(const std::vector<double>& values, const char* key, std::size_t cameras,
                 const std::string& where) {
  if (values.empty() || values.size() == cameras) return;
  throw ConfigError(fmt::format("{}: sensor.{} has {} numbers, expected one per camera: {}", where,
                                key, values.size(), cameras));
}

constexpr std::size_t kDepthNoiseSamples = std::size_t{1} << 20;
constexpr std::uint32_t kStream = 1;  // 0 is the colour noise's

}  // namespace

Sensor::Sensor(const SensorParams& params, std::size_t cameras, const std::string& where)
    : params_(params) {
  check_count(params_.gain, "gain", cameras, where);
  check_count(params_.offset, "offset", cameras, where);
  params_.gain.resize(cameras, 1.0);
  params_.offset.resize(cameras, 0.0);
  if (params_.noise_sigma <= 0) return;
  cv::RNG random(static_cast<std::uint64_t>(params_.seed) * 104729 + 3);
  cv::Mat noise(1, static_cast<int>(kNoiseSamples), CV_32FC1), rounded;
  random.fill(noise, cv::RNG::NORMAL, 0.0, params_.noise_sigma);
  noise.convertTo(rounded, CV_8SC1);
  noise_.assign(rounded.ptr<std::int8_t>(), rounded.ptr<std::int8_t>() + kNoiseSamples);
}

void Sensor::apply(cv::Mat& image, int frame, std::size_t camera) const {
  if (params_.blur_sigma > 0) cv::GaussianBlur(image, image, {}, params_.blur_sigma);
  const double gain = params_.gain[camera], offset = params_.offset[camera];
  if (gain != 1 || offset != 0) image.convertTo(image, CV_8UC3, gain, offset);
  if (!noise_.empty()) add_noise(image, frame, camera);
}

void Sensor::add_noise(cv::Mat& image, int frame, std::size_t camera) const {
  const auto length = static_cast<std::size_t>(image.cols) * 3;
  const cv::v_uint8x16 middle = cv::v_setall_u8(128);
  for (int y = 0; y < image.rows; ++y) {
    const RandomIndex index{static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(camera),
                            static_cast<std::uint32_t>(frame), 0};
    const double place = uniform4(static_cast<std::uint64_t>(params_.seed), index)[0];
    const auto room = static_cast<double>(kNoiseSamples - length);
    const std::int8_t* noise = noise_.data() + static_cast<std::size_t>(place * room);
    std::uint8_t* row = image.ptr<std::uint8_t>(y);
    std::size_t i = 0;
    for (; i + 16 <= length; i += 16) {
      // Less 128, levels are signed, and clamped as noise is added.
      const cv::v_int8x16 level = cv::v_reinterpret_as_s8(cv::v_load(row + i) ^ middle);
      const cv::v_int8x16 noisy = level + cv::v_load(noise + i);
      cv::v_store(row + i, cv::v_reinterpret_as_u8(noisy) ^ middle);
    }
    for (; i < length; ++i)
      row[i] = static_cast<std::uint8_t>(std::clamp(row[i] + noise[i], 0, 255));
  }
}

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
