#include "rectified_pair.hpp"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "hypotrack/api/error.hpp"

namespace hypotrack::depth_from_stereo {
namespace {

constexpr double kShortestBaseline = 1e-3;  // metres
// A larger rotation of a camera leaves too little of its picture.
constexpr double kLargestTurn = 25 * 3.14159265358979323846 / 180;

struct Rectification {
  std::array<cv::Matx33d, 2> turn;        ///< rectified_from_camera
  std::array<cv::Matx34d, 2> projection;  ///< of the rectified cameras
};

cv::Matx33d intrinsics(const Camera& camera) {
  return {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
}

bool is_fisheye(const Camera& camera) {
  return camera.distortion_model == DistortionModel::fisheye;
}

void check(const std::vector<Camera>& cameras, const std::string& where) {
  if (cameras.size() != 2) {
    throw DataError(fmt::format("{}: the source has {} camera{}; expected two, left and right",
                                where, cameras.size(), cameras.size() == 1 ? "" : "s"));
  }
  const Camera &a = cameras[0], &b = cameras[1];
  if (a.width != b.width || a.height != b.height) {
    throw DataError(
        fmt::format("{}: the cameras' images are {}x{} and {}x{} pixels; expected one size", where,
                    a.width, a.height, b.width, b.height));
  }
  if (is_fisheye(a) != is_fisheye(b)) {
    throw DataError(where +
                    ": one camera has a fisheye lens, the other one has not; expected "
                    "lenses of one kind");
  }
}

Rectification rectification_of(const Camera& a, const Camera& b) {
  const Eigen::Isometry3d b_from_a = b.camera_from_world * a.camera_from_world.inverse();
  cv::Matx33d r;
  cv::Matx31d t;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r(i, j) = b_from_a.linear()(i, j);
    t(i) = b_from_a.translation()(i);
  }
  const cv::Matx33d k_a = intrinsics(a), k_b = intrinsics(b);
  const cv::Size size(a.width, a.height);
  Rectification to;
  cv::Matx44d q;
  if (is_fisheye(a)) {
    cv::fisheye::stereoRectify(k_a, a.distortion, k_b, b.distortion, size, r, t, to.turn[0],
                               to.turn[1], to.projection[0], to.projection[1], q,
                               cv::CALIB_ZERO_DISPARITY);
  } else {
    cv::stereoRectify(k_a, a.distortion, k_b, b.distortion, size, r, t, to.turn[0], to.turn[1],
                      to.projection[0], to.projection[1], q, cv::CALIB_ZERO_DISPARITY);
  }
  return to;
}

/// Computes for every pixel of a rectified image its position in the camera's image.
void make_map(const Camera& camera, const cv::Matx33d& turn, const cv::Matx34d& projection,
              cv::Size size, cv::Mat& x, cv::Mat& y) {
  if (is_fisheye(camera)) {
    cv::fisheye::initUndistortRectifyMap(intrinsics(camera), camera.distortion, turn, projection,
                                         size, CV_32FC1, x, y);
  } else {
    cv::initUndistortRectifyMap(intrinsics(camera), camera.distortion, turn, projection, size,
                                CV_32FC1, x, y);
  }
}

/// Returns a pinhole camera at the place of `camera`.
Camera turned(const Camera& camera, const cv::Matx33d& turn, const cv::Matx34d& projection) {
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 9; ++i) rotation(i / 3, i % 3) = turn.val[i];
  Camera out;
  out.width = camera.width;
  out.height = camera.height;
  out.fx = projection(0, 0);
  out.fy = projection(1, 1);
  out.cx = projection(0, 2);
  out.cy = projection(1, 2);
  out.camera_from_world.linear() = rotation * camera.camera_from_world.linear();
  out.camera_from_world.translation() = rotation * camera.camera_from_world.translation();
  return out;
}

}  // namespace

RectifiedPair::RectifiedPair(const std::vector<Camera>& cameras, const std::string& where) {
  check(cameras, where);
  const Eigen::Vector3d baseline =
      cameras[0].camera_from_world * cameras[1].camera_from_world.inverse().translation();
  if (baseline.norm() < kShortestBaseline) {
    throw DataError(fmt::format("{}: the cameras are {:.3g} mm apart; expected 1 mm or more", where,
                                1e3 * baseline.norm()));
  }
  const Rectification to = rectification_of(cameras[0], cameras[1]);
  for (const cv::Matx33d& turn : to.turn) {
    if (turn(2, 2) >= std::cos(kLargestTurn) && to.projection[1](0, 3) != 0) continue;
    throw DataError(fmt::format(
        "{}: the second camera is at ({:.3g}, {:.3g}, {:.3g}) m of the first; expected one beside "
        "the other, with axes that are nearly parallel",
        where, baseline.x(), baseline.y(), baseline.z()));
  }
  camera_ = turned(cameras[0], to.turn[0], to.projection[0]);
  focal_baseline_ = -to.projection[1](0, 3);

  const cv::Size size(camera_.width, camera_.height);
  for (std::size_t i = 0; i < 2; ++i) {
    make_map(cameras[i], to.turn[i], to.projection[i], size, map_x_[i], map_y_[i]);
    seen_[i] = rectify_mask(cv::Mat(size, CV_8U, cv::Scalar(255)), i);
  }
}

cv::Mat RectifiedPair::rectify(const cv::Mat& image, std::size_t camera) const {
  cv::Mat out;
  cv::remap(image, out, map_x_[camera], map_y_[camera], cv::INTER_LINEAR);
  return out;
}

cv::Mat RectifiedPair::rectify_mask(const cv::Mat& mask, std::size_t camera) const {
  cv::Mat out;
  cv::remap(mask, out, map_x_[camera], map_y_[camera], cv::INTER_NEAREST);
  return out;
}

}  // namespace hypotrack::depth_from_stereo
