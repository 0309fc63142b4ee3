#include "track/color/background_model.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <cmath>

#include "track/color/background_row.hpp"

namespace hypotrack::internal {
namespace {

BackgroundRow row_of(std::array<cv::Mat1s, 3>& means, cv::Mat1b& steady, int y,
                     const cv::Range& columns) {
  BackgroundRow row{{}, steady[y] + columns.start, columns.size()};
  for (std::size_t i = 0; i < means.size(); ++i) row.means[i] = means[i][y] + columns.start;
  return row;
}

}  // namespace

void BackgroundModel::learn(const cv::Mat3b& picture, const cv::Mat1b& models) {
  constexpr int kRows = 16;  // per task
  if (steady_.size() != picture.size()) {
    for (cv::Mat1s& mean : means_) mean = cv::Mat1s(picture.size(), short{0});
    steady_ = cv::Mat1b(picture.size(), uchar{0});
  }
  const cv::Mat1b nowhere = models.empty() ? cv::Mat1b(1, picture.cols, uchar{0}) : cv::Mat1b();
  tbb::parallel_for(tbb::blocked_range<int>(0, picture.rows, kRows), [&](const auto& rows) {
    for (int y = rows.begin(); y != rows.end(); ++y)
      learn_background(picture.ptr(y), models.empty() ? nowhere[0] : models[y],
                       row_of(means_, steady_, y, {0, picture.cols}));
  });
}

cv::Mat4b BackgroundModel::background(const cv::Rect& part) const {
  cv::Mat4b out(part.size());
  auto means = means_;  // the same pixels, which the kernel only reads
  cv::Mat1b steady = steady_;
  for (int y = 0; y < part.height; ++y)
    write_background(row_of(means, steady, part.y + y, {part.x, part.x + part.width}), out.ptr(y));
  return out;
}

cv::Mat1f BackgroundModel::changed(const cv::Mat3b& picture) const {
  constexpr float kNoise = 4;         // levels of a channel
  constexpr float kUnchanged = 0.1f;  // weight of an unchanged pixel
  cv::Mat1f out(picture.size(), 1.0f);
  if (steady_.size() != picture.size()) return out;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      if (steady_(y, x) <= BackgroundRow::kKnown) continue;
      cv::Vec3f apart(picture(y, x));
      for (int i = 0; i < 3; ++i)
        apart[i] -=
            static_cast<float>(means_[static_cast<std::size_t>(i)](y, x)) / BackgroundRow::kOne;
      const float square = apart.dot(apart) / 3 / (kNoise * kNoise);
      out(y, x) = 1 - (1 - kUnchanged) * std::exp(-square / 2);
    }
  return out;
}

}  // namespace hypotrack::internal
