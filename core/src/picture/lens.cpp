#include "picture/lens.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kLargestPinhole = 6144;  // pixels along one side
constexpr double kLargestGeometry = 8192;
/// Factor by which geometry is drawn finer, so that the nearest pixel is at most 1/8 pixel off.
constexpr int kGeometryScale = 4;

void fill_row(const Camera& camera, int y, cv::Point2f* row) {
  Eigen::Matrix2Xd pixels(2, camera.width);
  pixels.row(0).setLinSpaced(camera.width, 0, camera.width - 1);
  pixels.row(1).setConstant(y);
  const Eigen::Matrix3Xd rays = back_project(camera, pixels);
  for (int x = 0; x < camera.width; ++x)
    row[x] = {static_cast<float>(rays(0, x)), static_cast<float>(rays(1, x))};
}

bool contains(const Eigen::AlignedBox2d& box, const cv::Point2f& p) {
  return p.x >= box.min().x() && p.x <= box.max().x() && p.y >= box.min().y() &&
         p.y <= box.max().y();  // false for NaN
}

Eigen::AlignedBox2d grown(Eigen::AlignedBox2d box, double margin) {
  box.min().array() -= margin;
  box.max().array() += margin;
  return box;
}

/// Returns the smallest step between neighbouring rays of a part of the image, which determines the
/// resolution to draw with.
double finest_step(const cv::Mat& rays) {
  double finest = std::numeric_limits<double>::infinity();
  for (int y = 0; y + 1 < rays.rows; y += 2) {
    const auto* row = rays.ptr<cv::Point2f>(y);
    const auto* below = rays.ptr<cv::Point2f>(y + 1);
    for (int x = 0; x + 1 < rays.cols; x += 2) {
      for (const cv::Point2f& next : {row[x + 1], below[x]}) {
        const double step = std::hypot(next.x - row[x].x, next.y - row[x].y);
        if (step > 0) finest = std::min(finest, step);  // false for NaN
      }
    }
  }
  return finest;
}

template <class T>
void pick_nearest(const cv::Mat& source, const cv::Mat& map, int scale, cv::Mat& target) {
  for (int y = 0; y < map.rows; ++y) {
    const auto* from = map.ptr<cv::Point2f>(y);
    T* to = target.ptr<T>(y);
    for (int x = 0; x < map.cols; ++x) {
      if (const auto pixel = nearest_pixel(from[x], scale, source.size()))
        to[x] = source.at<T>(*pixel);
    }
  }
}

}  // namespace

TileCamera finer(TileCamera camera, int scale) {
  camera.width *= scale;
  camera.height *= scale;
  camera.fx *= scale;
  camera.fy *= scale;
  camera.cx = scale * (camera.cx + 0.5) - 0.5;
  camera.cy = scale * (camera.cy + 0.5) - 0.5;
  return camera;
}

std::optional<cv::Point> nearest_pixel(const cv::Point2f& at, int scale, const cv::Size& size) {
  if (!std::isfinite(at.x)) return std::nullopt;
  const cv::Point pixel(cvRound(scale * (at.x + 0.5F) - 0.5F),
                        cvRound(scale * (at.y + 0.5F) - 0.5F));
  return pixel.inside({{}, size}) ? std::optional(pixel) : std::nullopt;
}

LensRays::LensRays(const Camera& camera) : camera_(camera) {
  if (camera.distortion_model == DistortionModel::none) return;
  rays_.create(camera.height, camera.width, CV_32FC2);
  for (int y = 0; y < camera.height; ++y) fill_row(camera, y, rays_.ptr<cv::Point2f>(y));
}

bool LensRays::fits(const Camera& c) const {
  return c.width == camera_.width && c.height == camera_.height && c.fx == camera_.fx &&
         c.fy == camera_.fy && c.cx == camera_.cx && c.cy == camera_.cy &&
         c.distortion_model == camera_.distortion_model && c.distortion == camera_.distortion;
}

LensView LensRays::view(const Eigen::AlignedBox2d& extent,
                        const Eigen::Isometry3d& camera_from_world) const {
  if (extent.isEmpty()) return {};
  LensView view = rays_.empty() ? pinhole_view(extent) : distorted_view(extent);
  view.pinhole.camera_from_world = camera_from_world;
  return view;
}

LensView LensRays::pinhole_view(const Eigen::AlignedBox2d& extent) const {
  const Camera& c = camera_;
  const auto pixel = [](double x, int size) {
    return static_cast<int>(std::clamp<double>(x, -2, size + 2));
  };
  const cv::Point first(pixel(std::floor(c.fx * extent.min().x() + c.cx) - 1, c.width),
                        pixel(std::floor(c.fy * extent.min().y() + c.cy) - 1, c.height));
  const cv::Point last(pixel(std::ceil(c.fx * extent.max().x() + c.cx) + 2, c.width),
                       pixel(std::ceil(c.fy * extent.max().y() + c.cy) + 2, c.height));
  LensView view;
  view.roi = cv::Rect(first, last) & cv::Rect(0, 0, c.width, c.height);
  if (view.roi.empty()) return {};
  view.pinhole = {view.roi.width,
                  view.roi.height,
                  c.fx,
                  c.fy,
                  c.cx - view.roi.x,
                  c.cy - view.roi.y,
                  Eigen::Isometry3d::Identity()};
  return view;
}

LensView LensRays::distorted_view(const Eigen::AlignedBox2d& extent) const {
  const Eigen::AlignedBox2d wanted = grown(extent, 2 / std::min(camera_.fx, camera_.fy));
  Eigen::AlignedBox2i pixels;
  Eigen::AlignedBox2d seen;
  for (int y = 0; y < rays_.rows; ++y) {
    const auto* row = rays_.ptr<cv::Point2f>(y);
    for (int x = 0; x < rays_.cols; ++x) {
      if (!contains(wanted, row[x])) continue;
      pixels.extend(Eigen::Vector2i(x, y));
      seen.extend(Eigen::Vector2d(row[x].x, row[x].y));
    }
  }
  if (pixels.isEmpty()) return {};
  LensView view;
  view.roi = {pixels.min().x(), pixels.min().y(), pixels.sizes().x() + 1, pixels.sizes().y() + 1};
  const cv::Mat rays = rays_(view.roi);
  const double widest = seen.sizes().maxCoeff();
  double focal = std::min(1 / finest_step(rays), 4 * std::max(camera_.fx, camera_.fy));
  focal = std::min(std::max(focal, 1.0), kLargestPinhole / std::max(widest, 1e-9));
  const int margin = 2;
  view.pinhole = {static_cast<int>(std::ceil(focal * seen.sizes().x())) + 2 * margin + 1,
                  static_cast<int>(std::ceil(focal * seen.sizes().y())) + 2 * margin + 1,
                  focal,
                  focal,
                  margin - focal * seen.min().x(),
                  margin - focal * seen.min().y(),
                  Eigen::Isometry3d::Identity()};
  const int largest = std::max(view.pinhole.width, view.pinhole.height);
  view.geometry_scale = std::clamp(static_cast<int>(kLargestGeometry / largest), 1, kGeometryScale);
  view.map = rays * focal + cv::Scalar(view.pinhole.cx, view.pinhole.cy);
  return view;
}

cv::Mat sample_linear(const cv::Mat& source, const LensView& view) {
  cv::Mat map = view.map.clone();
  cv::patchNaNs(map, -1e4);  // outside, hence zero
  cv::Mat target;
  cv::remap(source, target, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return target;
}

cv::Mat sample_nearest(const cv::Mat& source, const LensView& view) {
  cv::Mat target = cv::Mat::zeros(view.map.size(), source.type());
  if (source.type() == CV_32FC1) {
    pick_nearest<float>(source, view.map, view.geometry_scale, target);
  } else {
    CV_Assert(source.type() == CV_8UC1);
    pick_nearest<unsigned char>(source, view.map, view.geometry_scale, target);
  }
  return target;
}

}  // namespace hypotrack::internal
