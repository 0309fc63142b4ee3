#include "hypotrack/api/camera.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "camera/lens/distort.hpp"
#include "camera/lens/distortion.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kRotationTolerance = 1e-4;

std::string_view model_name(DistortionModel model) {
  switch (model) {
    case DistortionModel::none:
      return "none";
    case DistortionModel::brown:
      return "brown";
    case DistortionModel::fisheye:
      return "fisheye";
  }
  return "unknown";
}

void check_distortion(const Camera& camera, std::string_view where) {
  const std::size_t n = camera.distortion.size();
  const char* expected = nullptr;
  switch (camera.distortion_model) {
    case DistortionModel::none:
      if (n != 0) expected = "none at all";
      break;
    case DistortionModel::brown:
      if (n != 4 && n != 5 && n != 8 && n != 12 && n != 14) {
        expected = "4, 5, 8, 12 or 14 (k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]])";
      }
      break;
    case DistortionModel::fisheye:
      if (n != 4) expected = "4 (k1 k2 k3 k4)";
      break;
  }
  if (expected) {
    throw DataError(
        fmt::format("{}: {} distortion coefficients for the lens model '{}'; expected {}", where, n,
                    model_name(camera.distortion_model), expected));
  }
  for (const double k : camera.distortion) {
    if (!std::isfinite(k)) {
      throw DataError(
          fmt::format("{}: a distortion coefficient is {}; expected finite numbers", where, k));
    }
  }
}

void check_pose(const Camera& camera, std::string_view where) {
  const Eigen::Matrix3d r = camera.camera_from_world.linear();
  const Eigen::Vector3d t = camera.camera_from_world.translation();
  if (!r.allFinite() || !t.allFinite()) {
    throw DataError(fmt::format("{}: the pose holds NaN or infinite numbers", where));
  }
  const double error = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > kRotationTolerance) {
    throw DataError(
        fmt::format("{}: R is no rotation: R * R^T differs from the identity by {:.3g}; expected "
                    "an orthonormal "
                    "matrix within {:g}",
                    where, error, kRotationTolerance));
  }
  if (r.determinant() < 0) {
    throw DataError(fmt::format(
        "{}: R is a mirrored rotation (determinant -1); expected determinant +1. One axis of the "
        "calibration points the wrong way: OpenCV's are x right, y down, z forward",
        where));
  }
  constexpr double kFarthest = 1e4;  // metres
  if (t.norm() > kFarthest) {
    throw DataError(
        fmt::format("{}: T puts the camera {:.3g} m from the origin; expected {:g} m at most. Is "
                    "its unit right?",
                    where, t.norm(), kFarthest));
  }
}

/// Throws DataError unless the lens keeps the corners and edges of the image near it.
void check_lens_reach(const Camera& camera, std::string_view where) {
  constexpr double kFarthest = 10;  // diagonals of the image
  Camera lens = camera;
  lens.camera_from_world = Eigen::Isometry3d::Identity();
  const double diagonal = std::hypot(camera.width, camera.height);
  for (const double u : {0.0, 0.5, 1.0}) {
    for (const double v : {0.0, 0.5, 1.0}) {
      const Eigen::Vector2d pixel(u * camera.width, v * camera.height);
      const Eigen::Vector3d ray((pixel.x() - camera.cx) / camera.fx,
                                (pixel.y() - camera.cy) / camera.fy, 1);
      const double moved = (project(lens, ray) - pixel).norm();
      if (moved <= kFarthest * diagonal) continue;
      throw DataError(fmt::format(
          "{}: the distortion ({:g}) moves pixel ({:g}, {:g}) by {:.3g} pixels; expected {:.0f} at "
          "most. Are the coefficients in OpenCV's order, and the camera matrix in pixels?",
          where, fmt::join(camera.distortion, ", "), pixel.x(), pixel.y(), moved,
          kFarthest * diagonal));
    }
  }
}

/// Throws DataError if the lens folds on the first half of the way from the principal point to an
/// edge: pixels farther out show what nearer ones show. Real lenses fold outside the picture, or
/// near its corners.
void check_lens_folds(const Camera& camera, std::string_view where) {
  const double radius = monotonic_radius(camera);
  if (std::isinf(radius)) return;
  Camera lens = camera;
  lens.camera_from_world = Eigen::Isometry3d::Identity();
  const Eigen::Vector2d centre(camera.cx, camera.cy);
  const double shown = std::max((project(lens, {radius, 0, 1}) - centre).norm(),
                                (project(lens, {0, radius, 1}) - centre).norm());
  const double expected = std::min(camera.width, camera.height) / 4.0;
  if (shown >= expected) return;
  throw DataError(fmt::format(
      "{}: with the distortion ({:g}), nothing is seen farther than {:.3g} pixels from the "
      "principal point; expected {:g} at least. Are the coefficients in OpenCV's order, and the "
      "camera matrix in pixels?",
      where, fmt::join(camera.distortion, ", "), shown, expected));
}

/// Throws DataError unless focal length and principal point suit the size of the image.
void check_scale(const Camera& camera, std::string_view where) {
  constexpr double kShortest = 0.1, kLongest = 100, kFarthest = 5;  // image sizes
  for (const auto& [name, focal] : {std::pair{"fx", camera.fx}, std::pair{"fy", camera.fy}}) {
    if (focal >= kShortest * camera.width && focal <= kLongest * camera.width) continue;
    throw DataError(fmt::format(
        "{}: the focal length {} is {:g} pixels for an image of {}x{}; expected {:g} to {:g}. Does "
        "the calibration belong to pictures of this size?",
        where, name, focal, camera.width, camera.height, kShortest * camera.width,
        kLongest * camera.width));
  }
  for (const auto& [name, centre, size] :
       {std::tuple{"cx", camera.cx, camera.width}, std::tuple{"cy", camera.cy, camera.height}}) {
    if (std::abs(centre) <= kFarthest * size) continue;
    throw DataError(fmt::format(
        "{}: the principal point's {} is {:g} pixels for an image of {}x{}; expected {} to {}. "
        "Does "
        "the calibration belong to pictures of this size?",
        where, name, centre, camera.width, camera.height, -kFarthest * size, kFarthest * size));
  }
}

/// Returns what a sensor that is turned by two angles makes of a point on z = 1: a matrix, and a
/// division by z. Source: "Camera Calibration and 3D Reconstruction" in OpenCV's documentation.
Eigen::Matrix3d tilt_of_sensor(double tau_x, double tau_y) {
  if (tau_x == 0 && tau_y == 0) return Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(-tau_y, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(-tau_x, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  Eigen::Matrix3d to_sensor;
  to_sensor << turn(2, 2), 0, -turn(0, 2), 0, turn(2, 2), -turn(1, 2), 0, 0, 1;
  return to_sensor * turn;
}

}  // namespace

bool has_prisms_or_tilt(const Camera& camera) {
  constexpr std::size_t kPlain = 8;
  return camera.distortion_model == DistortionModel::brown && camera.distortion.size() > kPlain;
}

DistortionCoefficients distortion_coefficients(const Camera& camera) {
  constexpr std::size_t kTilt = 12;
  DistortionCoefficients k{};
  std::copy_n(camera.distortion.begin(), std::min(camera.distortion.size(), kTilt), k.begin());
  if (camera.distortion.size() <= kTilt) {  // at once, for whoever projects point by point
    k[kTilt] = k[kTilt + 3] = k[kTilt + 6] = 1;
    return k;
  }
  const Eigen::Matrix3d tilt =
      tilt_of_sensor(camera.distortion[kTilt], camera.distortion[kTilt + 1]);
  std::size_t at = kTilt;
  for (const auto& [row, column] :
       {std::pair{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}})
    k[at++] = tilt(row, column);
  return k;
}

double monotonic_radius(const Camera& camera) {
  constexpr double kStep = 1.0 / 1024;                        // radians
  constexpr double kLast = std::numbers::pi / 2 - 4 * kStep;  // tan() = 256
  const DistortionCoefficients k = distortion_coefficients(camera);
  double previous = 0;
  for (double angle = kStep; angle < kLast; angle += kStep) {
    const double r = std::tan(angle);
    double distorted = r;
    if (camera.distortion_model == DistortionModel::fisheye) {
      distorted = r * fisheye_factor(k.data(), r);
    } else if (camera.distortion_model == DistortionModel::brown) {
      const double r2 = r * r;
      const double below = 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
      if (below <= 0) return std::tan(angle - kStep);
      distorted = r * (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / below;
    }
    if (distorted <= previous) return std::tan(angle - kStep);
    previous = distorted;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace hypotrack::internal

namespace hypotrack {

Eigen::Vector2d project(const Camera& camera, const Eigen::Vector3d& p_world) {
  const Eigen::Vector3d p = camera.camera_from_world * p_world;
  if (!(p.z() > 0)) return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  double x = p.x() / p.z();
  double y = p.y() / p.z();
  if (camera.distortion_model != DistortionModel::none) {
    const DistortionCoefficients k = distortion_coefficients(camera);
    if (camera.distortion_model == DistortionModel::brown) {
      double xd = 0;
      double yd = 0;
      if (has_prisms_or_tilt(camera))
        distort_full(k.data(), x, y, xd, yd);
      else
        distort_brown(k.data(), x, y, xd, yd);
      x = xd;
      y = yd;
    } else {
      const double factor = fisheye_factor(k.data(), std::hypot(x, y));
      x *= factor;
      y *= factor;
    }
  }
  return {camera.fx * x + camera.cx, camera.fy * y + camera.cy};
}

void validate(const Camera& camera, std::string_view where) {
  if (camera.width <= 0 || camera.height <= 0) {
    throw DataError(fmt::format("{}: the image size is {}x{} pixels; expected positive numbers",
                                where, camera.width, camera.height));
  }
  if (!(std::isfinite(camera.fx) && std::isfinite(camera.fy) && camera.fx > 0 && camera.fy > 0)) {
    throw DataError(fmt::format(
        "{}: the focal lengths are fx = {:g}, fy = {:g} pixels; expected positive numbers", where,
        camera.fx, camera.fy));
  }
  if (!std::isfinite(camera.cx) || !std::isfinite(camera.cy)) {
    throw DataError(fmt::format("{}: the principal point is ({:g}, {:g}); expected finite numbers",
                                where, camera.cx, camera.cy));
  }
  check_scale(camera, where);
  check_distortion(camera, where);
  check_lens_reach(camera, where);
  check_lens_folds(camera, where);
  check_pose(camera, where);
}

}  // namespace hypotrack
