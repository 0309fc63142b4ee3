#include "track/color/background_model.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <cmath>

namespace hypotrack::internal {
void BackgroundModel::learn(const cv::Mat3b& picture, const cv::Mat1b& models) {
  constexpr float kRate = 0.125f;                    // of a frame in the mean
  constexpr float kSame = 12;                        // levels of a channel: at most noise
  constexpr int kKnownAbove = 140, kAnewBelow = 60;  // steadiness
  if (mean_.size() != picture.size()) {
    mean_.create(picture.size());
    steady_ = cv::Mat1b(picture.size(), uchar{0});
    background_ = cv::Mat4b(picture.size(), cv::Vec4b(0, 0, 0, 0));
  }
  tbb::parallel_for(0, picture.rows, [&](int y) {
    for (int x = 0; x < picture.cols; ++x) {
      if (!models.empty() && models(y, x)) continue;
      const cv::Vec3f color(picture(y, x));
      cv::Vec3f& mean = mean_(y, x);
      uchar& steady = steady_(y, x);
      const cv::Vec3f apart = color - mean;
      const bool same =
          std::abs(apart[0]) < kSame && std::abs(apart[1]) < kSame && std::abs(apart[2]) < kSame;
      const float agreed = static_cast<float>(steady) * (1 - kRate) + (same ? 255 * kRate : 0);
      steady = cv::saturate_cast<uchar>(agreed);
      mean = !same && steady < kAnewBelow ? color : mean + kRate * apart;
      background_(y, x) = {cv::saturate_cast<uchar>(mean[0]), cv::saturate_cast<uchar>(mean[1]),
                           cv::saturate_cast<uchar>(mean[2]),
                           static_cast<uchar>(steady > kKnownAbove ? 255 : 0)};
    }
  });
}

cv::Mat1f BackgroundModel::changed(const cv::Mat3b& picture) const {
  constexpr float kNoise = 4;         // levels of a channel
  constexpr float kUnchanged = 0.1f;  // weight of an unchanged pixel
  cv::Mat1f out(picture.size(), 1.0f);
  if (background_.size() != picture.size()) return out;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      if (background_(y, x)[3] == 0) continue;
      const cv::Vec3f apart = cv::Vec3f(picture(y, x)) - mean_(y, x);
      const float square = apart.dot(apart) / 3 / (kNoise * kNoise);
      out(y, x) = 1 - (1 - kUnchanged) * std::exp(-square / 2);
    }
  return out;
}

}  // namespace hypotrack::internal
