#include "track/recover/background_model.hpp"

#include <cmath>

namespace hypotrack {
namespace {

constexpr float kRate = 0.1f;       // of a frame in the mean
constexpr float kSame = 4;          // levels of a channel, 0 .. 255: a difference that is noise
constexpr float kUnchanged = 0.1f;  // weight of a pixel that is the same

}  // namespace

void BackgroundModel::learn(const cv::Mat3b& picture, const cv::Mat1b& foreground) {
  if (mean_.size() != picture.size()) {
    mean_.create(picture.size());
    known_ = cv::Mat1b(picture.size(), uchar{0});
  }
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      if (!foreground.empty() && foreground(y, x)) continue;
      const cv::Vec3f color(picture(y, x));
      cv::Vec3f& mean = mean_(y, x);
      mean = known_(y, x) ? mean + kRate * (color - mean) : color;
      known_(y, x) = 255;
    }
}

cv::Mat1f BackgroundModel::changed(const cv::Mat3b& picture) const {
  cv::Mat1f out(picture.size(), 1.0f);
  if (mean_.size() != picture.size()) return out;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      if (!known_(y, x)) continue;
      const cv::Vec3f apart = cv::Vec3f(picture(y, x)) - mean_(y, x);
      const float square = apart.dot(apart) / 3 / (kSame * kSame);
      out(y, x) = 1 - (1 - kUnchanged) * std::exp(-square / 2);
    }
  return out;
}

}  // namespace hypotrack
