#include "matcher.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hypotrack/api/error.hpp"

namespace hypotrack::depth_from_stereo {
namespace {

constexpr int kCountStep = 16;     // StereoSGBM's numbers of disparities
constexpr float kFixedPoint = 16;  // disparities of StereoSGBM are in sixteenths of a pixel
constexpr int kContrastLimit = 63;

int mode_of(Mode mode) {
  switch (mode) {
    case Mode::eight_ways:
      return cv::StereoSGBM::MODE_HH;
    case Mode::three_ways:
      return cv::StereoSGBM::MODE_SGBM_3WAY;
    default:
      return cv::StereoSGBM::MODE_SGBM;
  }
}

}  // namespace

Matcher::Matcher(const Params& params, const RectifiedPair& pair, const std::string& where)
    : pair_(&pair) {
  if (params.nearest >= params.farthest) {
    throw ConfigError(fmt::format("{}: nearest_mm is {:g}, farthest_mm {:g}; expected it farther",
                                  where, params.nearest * 1e3, params.farthest * 1e3));
  }
  if (params.block_size % 2 == 0) {
    throw ConfigError(
        fmt::format("{}: block_size is {}; expected an odd number", where, params.block_size));
  }
  const double near = pair.focal_baseline() / params.nearest;
  const double far = pair.focal_baseline() / params.farthest;
  if (std::max(std::abs(near), std::abs(far)) >= pair.camera().width) {
    throw ConfigError(fmt::format(
        "{}: nearest_mm {:g} is a disparity of {:.0f} pixels between these cameras, whose images "
        "are {} wide; expected {:.0f} mm or more",
        where, params.nearest * 1e3, std::abs(near), pair.camera().width,
        std::ceil(1e3 * std::abs(pair.focal_baseline()) / pair.camera().width) + 1));
  }
  lowest_ = static_cast<int>(std::floor(std::min(near, far)));
  const int highest = static_cast<int>(std::ceil(std::max(near, far)));
  count_ = (highest - lowest_ + kCountStep) / kCountStep * kCountStep;
  // Penalties as in OpenCV's stereo_match sample: 8 and 32 per channel and pixel of the block.
  const double block = 3.0 * params.block_size * params.block_size * params.smoothness;
  sgbm_ = cv::StereoSGBM::create(lowest_, count_, params.block_size, cvRound(8 * block),
                                 cvRound(32 * block), params.consistency, kContrastLimit,
                                 params.uniqueness, params.speckle_size, params.speckle_range,
                                 mode_of(params.mode));
}

cv::Mat Matcher::depth(const cv::Mat& first, const cv::Mat& second) {
  // StereoSGBM leaves out a margin as wide as the largest disparity: add one.
  const int left = std::max(0, lowest_ + count_);
  const int right = std::max(0, -lowest_);
  cv::Mat a, b, disparity;
  cv::copyMakeBorder(first, a, 0, 0, left, right, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(second, b, 0, 0, left, right, cv::BORDER_REPLICATE);
  sgbm_->compute(a, b, disparity);

  cv::Mat depth = cv::Mat::zeros(first.size(), CV_32F);
  const auto scale = static_cast<float>(pair_->focal_baseline()) * kFixedPoint;
  for (int y = 0; y < depth.rows; ++y) {
    const auto* from = disparity.ptr<short>(y) + left;
    const auto* here = pair_->seen(0).ptr<unsigned char>(y);
    const auto* there = pair_->seen(1).ptr<unsigned char>(y);
    auto* to = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (from[x] < lowest_ * static_cast<int>(kFixedPoint) || here[x] == 0) continue;
      const int other = x - cvRound(from[x] / kFixedPoint);
      const bool seen = other >= 0 && other < depth.cols && there[other] != 0;
      const float z = scale / from[x];
      if (seen && z > 0 && std::isfinite(z)) to[x] = z;
    }
  }
  return depth;
}

}  // namespace hypotrack::depth_from_stereo
