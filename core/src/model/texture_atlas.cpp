#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/mesh_io.hpp"

namespace hypotrack {
namespace {

constexpr int kMargin = 4;         // pixels around a picture that repeat its rim, for filtering
constexpr int kLargest = 2048;     // longest side of a picture
constexpr int kLargestAll = 8192;  // of the whole

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

}  // namespace

std::size_t TextureAtlas::add(const cv::Mat& picture) {
  cv::Mat fitting = picture;
  if (const int longest = std::max(picture.cols, picture.rows); longest > kLargest) {
    const double factor = static_cast<double>(kLargest) / longest;
    cv::resize(picture, fitting, cv::Size(), factor, factor, cv::INTER_AREA);
  }
  const auto known =
      std::ranges::find_if(pictures_, [&](const cv::Mat& other) { return same(other, fitting); });
  if (known != pictures_.end()) return static_cast<std::size_t>(known - pictures_.begin());
  pictures_.push_back(fitting);
  return pictures_.size() - 1;
}

std::size_t TextureAtlas::add(const Eigen::Vector3f& color) {
  const Eigen::Vector3f scaled = 255 * color;
  const cv::Vec3b bgr(cv::saturate_cast<uchar>(scaled.z()), cv::saturate_cast<uchar>(scaled.y()),
                      cv::saturate_cast<uchar>(scaled.x()));
  return add(cv::Mat(4, 4, CV_8UC3, cv::Scalar(bgr)));
}

cv::Mat TextureAtlas::texture(const std::string& where) {
  double area = 0;
  int widest = 0;
  for (const cv::Mat& picture : pictures_) {
    area += (picture.cols + 2.0 * kMargin) * (picture.rows + 2.0 * kMargin);
    widest = std::max(widest, picture.cols + 2 * kMargin);
  }
  std::vector<std::size_t> order(pictures_.size());  // by falling height, for rows without gaps
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [&](std::size_t i) { return pictures_[i].rows; });
  const int width = std::max(widest, static_cast<int>(std::ceil(std::sqrt(area))));
  places_.resize(pictures_.size());
  int left = 0, top = 0, row = 0;
  for (const std::size_t i : order) {
    const int across = pictures_[i].cols + 2 * kMargin, down = pictures_[i].rows + 2 * kMargin;
    if (left + across > width) {
      left = 0;
      top += row;
      row = 0;
    }
    places_[i] = {left + kMargin, top + kMargin, pictures_[i].cols, pictures_[i].rows};
    left += across;
    row = std::max(row, down);
  }
  width_ = width;
  height_ = top + row;
  if (std::max(width_, height_) > kLargestAll)
    throw DataError(
        fmt::format("{}: its textures need {} x {} pixels together, at most {} are possible on "
                    "each side: make the pictures smaller",
                    where, width_, height_, kLargestAll));
  cv::Mat all(height_, width_, CV_8UC3, cv::Scalar::all(0));
  for (std::size_t i = 0; i < pictures_.size(); ++i) {
    const Place& at = places_[i];
    cv::Mat framed =
        all({at.left - kMargin, at.top - kMargin, at.width + 2 * kMargin, at.height + 2 * kMargin});
    cv::copyMakeBorder(pictures_[i], framed, kMargin, kMargin, kMargin, kMargin,
                       cv::BORDER_REPLICATE);
  }
  return all;
}

Eigen::Matrix2Xf TextureAtlas::moved(std::size_t index,
                                     const Eigen::Ref<const Eigen::Matrix2Xf>& uv) const {
  const Place& at = places_[index];
  Eigen::Matrix2Xf out(2, uv.cols());
  out.row(0) = ((at.left + at.width * uv.row(0).cast<double>().array()) / width_).cast<float>();
  out.row(1) =
      (1 - (at.top + at.height * (1 - uv.row(1).cast<double>().array())) / height_).cast<float>();
  return out;
}

}  // namespace hypotrack
