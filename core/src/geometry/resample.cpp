#include "geometry/resample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace hypotrack {
namespace {

constexpr float kOutside = -1e4f;  // a coordinate no image has; fits the 16 bits of cv::remap

/// sqrt |det| of the map's derivative at the middle of the tile.
double scale_at_centre(const ImageMap& map, double fallback) {
  const int i = map.x.rows / 2;
  const float x = map.x.at<float>(i, i);
  const float y = map.y.at<float>(i, i);
  const float dxu = map.x.at<float>(i, i + 1) - x;
  const float dyu = map.y.at<float>(i, i + 1) - y;
  const float dxv = map.x.at<float>(i + 1, i) - x;
  const float dyv = map.y.at<float>(i + 1, i) - y;
  const double area = std::abs(double{dxu} * dyv - double{dyu} * dxv);
  const bool seen = x != kOutside && map.x.at<float>(i, i + 1) != kOutside &&
                    map.x.at<float>(i + 1, i) != kOutside;
  return seen && area > 0 ? std::sqrt(area) : fallback;
}

cv::Mat inside_mask(const ImageMap& map, int size, int width, int height) {
  cv::Mat valid(size, size, CV_8U);
  const float right = static_cast<float>(width) - 0.5f;
  const float bottom = static_cast<float>(height) - 0.5f;
  for (int v = 0; v < size; ++v) {
    const float* x = map.x.ptr<float>(v + 1) + 1;
    const float* y = map.y.ptr<float>(v + 1) + 1;
    auto* out = valid.ptr<unsigned char>(v);
    for (int u = 0; u < size; ++u) {
      const bool in = x[u] >= -0.5f && x[u] < right && y[u] >= -0.5f && y[u] < bottom;
      out[u] = in ? 255 : 0;
    }
  }
  return valid;
}

/// Depth at the nearest image pixel of every tile pixel, never a mixture of two, turned from the
/// camera's optical axis to the tile's. What is not a positive number counts as not measured.
cv::Mat nearest_depth(const cv::Mat& depth, const cv::Mat& valid, const ImageMap& map,
                      const TileCamera& tile, const Eigen::Matrix3f& camera_from_ideal) {
  const Eigen::RowVector3f axis = camera_from_ideal.row(2);
  cv::Mat out = cv::Mat::zeros(valid.size(), CV_32F);
  for (int v = 0; v < valid.rows; ++v) {
    const float* x = map.x.ptr<float>(v + 1) + 1;
    const float* y = map.y.ptr<float>(v + 1) + 1;
    const auto* inside = valid.ptr<unsigned char>(v);
    auto* to = out.ptr<float>(v);
    const auto ray_y = static_cast<float>((v - tile.cy) / tile.fy);
    for (int u = 0; u < valid.cols; ++u) {
      if (inside[u] == 0) continue;
      // Halves go up, as `inside` has it; cv::remap would take the even neighbour.
      const int column = static_cast<int>(std::floor(x[u] + 0.5f));
      const int row = static_cast<int>(std::floor(y[u] + 0.5f));
      const float z =
          depth.at<float>(std::min(row, depth.rows - 1), std::min(column, depth.cols - 1));
      const auto ray_x = static_cast<float>((u - tile.cx) / tile.fx);
      const float along = z / (axis.x() * ray_x + (axis.y() * ray_y + axis.z()));
      if (along > 0 && std::isfinite(along)) to[u] = along;
    }
  }
  return out;
}

/// The part of the image that the map's lookups touch, widened to whole blocks. The image's last
/// pixels that fill no block are left out.
cv::Rect touched(const ImageMap& map, const cv::Mat& valid, cv::Size image, int blocks) {
  double x0 = 0, x1 = 0, y0 = 0, y1 = 0;
  const cv::Rect inner(1, 1, valid.cols, valid.rows);
  if (cv::countNonZero(valid) == 0) return {};
  cv::minMaxLoc(map.x(inner), &x0, &x1, nullptr, nullptr, valid);
  cv::minMaxLoc(map.y(inner), &y0, &y1, nullptr, nullptr, valid);
  const auto range = [blocks, &map](double low, double high, int end) {
    const double margin = 2 * blocks + map.scale;
    const int last = end / blocks;
    const int first_block = std::clamp(static_cast<int>((low - margin) / blocks), 0, last - 1);
    const int end_block =
        std::clamp(static_cast<int>((high + margin) / blocks) + 1, first_block + 1, last);
    return cv::Range(first_block * blocks, end_block * blocks);
  };
  const cv::Range columns = range(x0, x1, image.width);
  const cv::Range rows = range(y0, y1, image.height);
  return {columns.start, rows.start, columns.size(), rows.size()};
}

/// Lookups of the tile in `image`; the map already has the image's coordinates.
cv::Mat look_up(const cv::Mat& image, const cv::Mat& x, const cv::Mat& y, int size, int samples) {
  cv::Mat out;
  if (samples == 1) {
    const cv::Rect inner(1, 1, size, size);
    cv::remap(image, out, x(inner), y(inner), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    return out;
  }
  cv::Mat fine;
  cv::remap(image, fine, x, y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::resize(fine, out, cv::Size(size, size), 0, 0, cv::INTER_AREA);
  return out;
}

}  // namespace

ReductionPlan plan_reduction(double scale) {
  constexpr double kSharp = 1.15;
  ReductionPlan plan;
  plan.blocks = std::max(1, static_cast<int>(scale));
  plan.samples = scale / plan.blocks > kSharp ? 2 : 1;
  return plan;
}

Resampler::Resampler(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal)
    : camera_(camera), camera_from_ideal_(camera_from_ideal.cast<float>()) {
  const DistortionCoefficients k = distortion_coefficients(camera);
  std::transform(k.begin(), k.end(), distortion_.begin(),
                 [](double v) { return static_cast<float>(v); });
  const double r = std::min(monotonic_radius(camera), 1e6);
  largest_r2_ = static_cast<float>(r * r);
}

ImageMap Resampler::map(const TileCamera& tile) const {
  using Row = Eigen::ArrayXf;
  const int columns = tile.width + 2;
  const int rows = tile.height + 2;
  ImageMap map{cv::Mat(rows, columns, CV_32F), cv::Mat(rows, columns, CV_32F), 1};
  const Eigen::Matrix3f& r = camera_from_ideal_;
  const Row u = (Row::LinSpaced(columns, -1.0f, static_cast<float>(tile.width)) -
                 static_cast<float>(tile.cx)) /
                static_cast<float>(tile.fx);
  const auto fx = static_cast<float>(camera_.fx);
  const auto fy = static_cast<float>(camera_.fy);
  const auto cx = static_cast<float>(camera_.cx);
  const auto cy = static_cast<float>(camera_.cy);
  Row x(columns), y(columns), z(columns), r2(columns), xd(columns), yd(columns);
  for (int row = 0; row < rows; ++row) {
    const float v =
        (static_cast<float>(row - 1) - static_cast<float>(tile.cy)) / static_cast<float>(tile.fy);
    z = r(2, 0) * u + (r(2, 1) * v + r(2, 2));
    x = (r(0, 0) * u + (r(0, 1) * v + r(0, 2))) / z;
    y = (r(1, 0) * u + (r(1, 1) * v + r(1, 2))) / z;
    r2 = x * x + y * y;
    switch (camera_.distortion_model) {
      case DistortionModel::none:
        xd = x;
        yd = y;
        break;
      case DistortionModel::brown:
        distort_brown(distortion_, x, y, xd, yd);
        break;
      case DistortionModel::fisheye:
        xd = r2.sqrt().unaryExpr([this](float d) { return fisheye_factor(distortion_, d); });
        yd = y * xd;
        xd = x * xd;
        break;
    }
    Eigen::Map<Row> map_x(map.x.ptr<float>(row), columns);
    Eigen::Map<Row> map_y(map.y.ptr<float>(row), columns);
    const auto seen = z > 0.0f && r2 < largest_r2_;
    map_x = seen.select(xd * fx + cx, kOutside);
    map_y = seen.select(yd * fy + cy, kOutside);
  }
  map.scale = scale_at_centre(map, std::sqrt(camera_.fx * camera_.fy) / tile.fx);
  return map;
}

TileView Resampler::cut(const View& view, const TileCamera& tile, const ImageMap& map,
                        const ReductionPlan& plan) const {
  const int size = tile.width;
  TileView out;
  out.camera = tile;
  out.valid = inside_mask(map, size, camera_.width, camera_.height);
  const int blocks = std::min({plan.blocks, camera_.width, camera_.height});
  if (!view.depth.empty())
    out.depth = nearest_depth(view.depth, out.valid, map, tile, camera_from_ideal_);
  if (view.color.empty() && view.mask.empty()) return out;
  const cv::Rect roi = touched(map, out.valid, {camera_.width, camera_.height}, blocks);
  if (roi.empty()) {
    if (!view.color.empty()) out.color = cv::Mat::zeros(size, size, CV_8UC3);
    if (!view.mask.empty()) out.mask = cv::Mat::zeros(size, size, CV_8U);
    return out;
  }
  // Pixel centres are at integers, so a block's centre is half a block less half a pixel in.
  const double factor = 1.0 / blocks;
  cv::Mat x, y;
  map.x.convertTo(x, CV_32F, factor, (0.5 - roi.x) * factor - 0.5);
  map.y.convertTo(y, CV_32F, factor, (0.5 - roi.y) * factor - 0.5);
  if (plan.samples > 1) {
    // Linear interpolation of the map is exact to about 0.001 pixels: lenses are smooth.
    const cv::Rect inner(plan.samples, plan.samples, size * plan.samples, size * plan.samples);
    const cv::Size fine(x.cols * plan.samples, x.rows * plan.samples);
    cv::resize(x, x, fine, 0, 0, cv::INTER_LINEAR);
    cv::resize(y, y, fine, 0, 0, cv::INTER_LINEAR);
    x = x(inner);
    y = y(inner);
  }
  const cv::Size reduced(roi.width / blocks, roi.height / blocks);
  const auto take = [&](cv::Mat part) {
    if (blocks > 1) {
      cv::Mat means;
      cv::resize(part, means, reduced, 0, 0, cv::INTER_AREA);
      part = means;
    }
    return look_up(part, x, y, size, plan.samples);
  };
  if (!view.color.empty()) out.color = take(view.color(roi));
  if (!view.mask.empty()) {
    out.mask = take(view.mask(roi) != 0) >= 128;
    out.mask &= out.valid;
  }
  return out;
}

}  // namespace hypotrack
