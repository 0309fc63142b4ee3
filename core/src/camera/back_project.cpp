#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "hypotrack/api/camera.hpp"

namespace hypotrack {
namespace {

/// Largest angle from the axis (tangent) of a ray.
constexpr double kWidestTangent = 6.0;       // 80.5 degrees
constexpr double kInversionTolerance = 0.1;  // pixels

cv::Matx33d intrinsics(const Camera& c) { return {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1}; }

std::vector<cv::Point2d> undistort(const Camera& c, const std::vector<cv::Point2d>& pixels) {
  std::vector<cv::Point2d> rays;
  if (c.distortion_model == DistortionModel::fisheye) {
    cv::fisheye::undistortPoints(pixels, rays, intrinsics(c), c.distortion);
  } else {
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 1e-8);
    cv::undistortPoints(pixels, rays, intrinsics(c), c.distortion, cv::noArray(), cv::noArray(),
                        until);
  }
  return rays;
}

std::vector<cv::Point2d> distort(const Camera& c, const std::vector<cv::Point2d>& rays) {
  std::vector<cv::Point2d> pixels;
  if (c.distortion_model == DistortionModel::fisheye) {
    cv::fisheye::distortPoints(rays, pixels, intrinsics(c), c.distortion);
  } else {
    std::vector<cv::Point3d> points;
    points.reserve(rays.size());
    for (const cv::Point2d& ray : rays) points.emplace_back(ray.x, ray.y, 1.0);
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), intrinsics(c), c.distortion, pixels);
  }
  return pixels;
}

}  // namespace

Eigen::Matrix3Xd back_project(const Camera& camera, const Eigen::Matrix2Xd& pixels) {
  if (pixels.cols() == 0) return {3, 0};
  std::vector<cv::Point2d> points;
  for (const auto pixel : pixels.colwise()) points.emplace_back(pixel.x(), pixel.y());
  std::vector<cv::Point2d> rays = undistort(camera, points);
  for (cv::Point2d& ray : rays) {
    const double tangent = std::hypot(ray.x, ray.y);
    if (!(tangent < kWidestTangent)) ray = {kWidestTangent, 0};  // fails the check below
  }
  // OpenCV inverts the distortion iteratively, and may fail.
  const std::vector<cv::Point2d> again = distort(camera, rays);
  Eigen::Matrix3Xd out(3, pixels.cols());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const cv::Point2d error = again[i] - points[i];
    if (std::hypot(error.x, error.y) < kInversionTolerance)
      out.col(static_cast<Eigen::Index>(i)) << rays[i].x, rays[i].y, 1;
    else
      out.col(static_cast<Eigen::Index>(i)).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

}  // namespace hypotrack
