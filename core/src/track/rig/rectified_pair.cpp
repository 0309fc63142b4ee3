#include "track/rig/rectified_pair.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/profile.hpp"
#include "camera/rectification.hpp"
#include "hypotrack/api/camera.hpp"
#include "tile/resample.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kWidth = 640;  // pixels: motion and rows are then known to half a pixel of 1280

/// Directions at depth 1.
struct Field {
  Eigen::Vector2d lowest{1e9, 1e9}, highest{-1e9, -1e9};
};

/// Returns the directions that a camera sees, in its ideal camera.
Field field_of(const Camera& camera, const Eigen::Matrix3d& camera_from_ideal) {
  constexpr double kWidest = 1.2;  // 50 degrees from the axis
  const double right = camera.width - 1, bottom = camera.height - 1;
  Eigen::Matrix2Xd border(2, 8);
  border << 0, right / 2, right, 0, right, 0, right / 2, right,  //
      0, 0, 0, bottom / 2, bottom / 2, bottom, bottom, bottom;
  Field field;
  const Eigen::Matrix3Xd rays = back_project(camera, border);
  for (const auto& ray : rays.colwise()) {
    const Eigen::Vector3d ideal = camera_from_ideal.transpose() * ray;
    const Eigen::Vector2d at = ideal.head<2>() / ideal.z();
    if (!at.allFinite() || ideal.z() <= 0) continue;
    field.lowest = field.lowest.cwiseMin(at);
    field.highest = field.highest.cwiseMax(at);
  }
  field.lowest = field.lowest.cwiseMax(-kWidest);
  field.highest = field.highest.cwiseMin(kWidest);
  return field;
}

/// Returns the part of a picture of this size that a map shows as it is; nothing unless it shows
/// one. Pictures of rectified cameras are such parts.
std::optional<cv::Rect> part_shown(const cv::Mat1f& x, const cv::Mat1f& y, const cv::Size& size) {
  constexpr float kExact = 0.01F;  // pixels
  const cv::Rect part(cv::Point(cvRound(x(0, 0)), cvRound(y(0, 0))), x.size());
  if ((part & cv::Rect({}, size)) != part) return std::nullopt;
  for (int row = 0; row < x.rows; ++row)
    for (int column = 0; column < x.cols; ++column)
      if (!(std::abs(x(row, column) - static_cast<float>(part.x + column)) < kExact &&
            std::abs(y(row, column) - static_cast<float>(part.y + row)) < kExact))
        return std::nullopt;
  return part;
}

}  // namespace

std::optional<RectifiedPair> RectifiedPair::make(const std::array<Camera, 2>& cameras) {
  const IdealRig rig = make_ideal_rig(cameras);
  if (!rig.rectified) return std::nullopt;
  Field field;
  for (std::size_t v = 0; v < 2; ++v) {
    const Field own = field_of(cameras[v], rig.camera_from_ideal[v]);
    field.lowest = field.lowest.cwiseMin(own.lowest);
    field.highest = field.highest.cwiseMax(own.highest);
  }
  const Eigen::Vector2d extent = field.highest - field.lowest;
  RectifiedPair out;
  out.focal_ = std::min(cameras[0].fx, kWidth / extent.maxCoeff());
  if (!(out.focal_ > 0) || !(extent.minCoeff() > 0)) return std::nullopt;
  out.baseline_ =
      (rig.ideal_from_world[0].translation() - rig.ideal_from_world[1].translation()).norm();
  out.center_ = -out.focal_ * field.lowest;
  out.second_ = cameras[1];
  out.second_from_ideal_ = rig.camera_from_ideal[1];
  out.shrink_ = std::max(1, static_cast<int>(cameras[0].fx / out.focal_ + 0.1));
  TileCamera small;
  small.width = static_cast<int>(std::floor(out.focal_ * extent.x()));
  small.height = static_cast<int>(std::floor(out.focal_ * extent.y()));
  small.fx = small.fy = out.focal_;
  small.cx = out.center_.x();
  small.cy = out.center_.y();
  for (std::size_t v = 0; v < 2; ++v) {
    const ImageMap map = Resampler(cameras[v], rig.camera_from_ideal[v]).map(small);
    const cv::Rect inside(1, 1, small.width, small.height);
    const auto shrunken = [&](const cv::Mat& pixels) {
      cv::Mat at;
      pixels(inside).convertTo(at, CV_32F, 1.0 / out.shrink_, 0.5 / out.shrink_ - 0.5);
      return at;
    };
    const cv::Mat1f x = shrunken(map.x), y = shrunken(map.y);
    const cv::Size size(cameras[v].width / out.shrink_, cameras[v].height / out.shrink_);
    out.part_[v] = part_shown(x, y, size);
    if (!out.part_[v]) cv::convertMaps(x, y, out.x_[v], out.y_[v], CV_16SC2);
  }
  return out;
}

GreyPair RectifiedPair::resample(const Frame& frame) const {
  const ProfiledPart part("rectify");
  GreyPair out;
  tbb::parallel_for(std::size_t{0}, out.size(), [&](std::size_t v) {
    cv::Mat shrunken = frame.views[v].color, grey;
    if (shrink_ > 1)
      cv::resize(shrunken, shrunken, shrunken.size() / shrink_, 0, 0, cv::INTER_AREA);
    if (part_[v]) return cv::cvtColor(shrunken(*part_[v]), out[v], cv::COLOR_BGR2GRAY);
    cv::cvtColor(shrunken, grey, cv::COLOR_BGR2GRAY);
    cv::remap(grey, out[v], x_[v], y_[v], cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  });
  return out;
}

cv::Matx33d RectifiedPair::displacement(double roll, double scale,
                                        const Eigen::Vector2d& shift) const {
  const Eigen::Matrix2d turn = (1 + scale) * Eigen::Rotation2Dd(roll).toRotationMatrix();
  const Eigen::Vector2d center(second_.cx, second_.cy);
  const Eigen::Vector2d to =
      center - turn * center + this->scale() * (second_from_ideal_.topLeftCorner<2, 2>() * shift);
  return {turn(0, 0), turn(0, 1), to.x(), turn(1, 0), turn(1, 1), to.y(), 0, 0, 1};
}

cv::Matx33d RectifiedPair::turned(double angle) const {
  Eigen::Matrix3d pixels;
  pixels << second_.fx, 0, second_.cx, 0, second_.fy, second_.cy, 0, 0, 1;
  const Eigen::Matrix3d pixels_from_ideal = pixels * second_from_ideal_;
  const Eigen::Matrix3d map = pixels_from_ideal *
                              Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()) *
                              pixels_from_ideal.inverse();
  cv::Matx33d out;
  cv::eigen2cv(map, out);
  return out;
}

}  // namespace hypotrack::internal
