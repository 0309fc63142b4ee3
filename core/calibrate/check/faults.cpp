#include "calibrate/check/faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace hypotrack::calibrate {
namespace {

/// Length of squares along the rows of a board as a multiple of that along its columns.
struct Stretch {
  double ratio = 1, sigma = 0;
};

/// Returns the sum of squared residuals with a board of stretched rows, in square pixels.
double squares_with(std::vector<CommonCorners> views, cv::Size pictures,
                    const std::array<Lens, 2>& lenses, int flags, double ratio) {
  double corners = 0;
  for (CommonCorners& view : views) {
    for (cv::Point3f& at : view.board) at.x *= static_cast<float>(ratio);
    corners += static_cast<double>(view.board.size());
  }
  std::array<Lens, 2> start;
  for (std::size_t i = 0; i < 2; ++i)
    start[i] = {lenses[i].matrix.clone(), lenses[i].distortion.clone()};
  const double rms = calibrate_both(views, pictures, start, flags).rms;
  return 2 * corners * rms * rms;
}

/// Measures squares by a parabola through the residuals of three boards.
Stretch stretch_of(const std::vector<CommonCorners>& views, cv::Size pictures,
                   const std::array<Lens, 2>& lenses, int flags) {
  constexpr double kStep = 0.005, kLeastFree = 1, kPose = 6, kLens = 9;
  const auto with = [&](double ratio) {
    return squares_with(views, pictures, lenses, flags, ratio);
  };
  const double below = with(1 - kStep), here = with(1), above = with(1 + kStep);
  const double curvature = (above - 2 * here + below) / (2 * kStep * kStep);
  const double slope = (above - below) / (2 * kStep);
  if (!(curvature > 0)) return {1, 1};
  double numbers = 0;
  for (const CommonCorners& view : views) numbers += 4 * static_cast<double>(view.board.size());
  const double free = std::max(kLeastFree, numbers - kPose * double(views.size() + 1) - 2 * kLens);
  const double least = std::max(0.0, here - slope * slope / (4 * curvature));
  return {1 - slope / (2 * curvature), std::sqrt(least / free / curvature)};
}

/// Returns what squares or pixels that are not square look like.
std::string of_squares(const Stretch& stretch, const std::array<Camera, 2>& cameras,
                       bool lenses_given) {
  constexpr double kLeast = 0.003, kSure = 5, kKnown = 0.002, kOther = 0.01;
  const double percent = 100 * std::abs(stretch.ratio - 1);
  if (percent > 100 * kLeast && percent > 100 * kSure * stretch.sigma)
    return fmt::format(
        "the squares look {:.1f} % {} along the board's rows than along its columns: measure "
        "several of them both ways; printers stretch paper",
        percent, stretch.ratio > 1 ? "longer" : "shorter");
  const double left = cameras[0].fx / cameras[0].fy - 1, right = cameras[1].fx / cameras[1].fy - 1;
  if (lenses_given || stretch.sigma < kKnown || left * right < 0 ||
      std::min(std::abs(left), std::abs(right)) < kOther)
    return {};
  return fmt::format(
      "both focal lengths are {:.1f} % {} across than down: squares that are not square look like "
      "that, and so do pixels; turn the board by 90 degrees in some pairs to tell",
      100 * std::abs(left), left > 0 ? "longer" : "shorter");
}

/// Returns that both cameras are one, or that the right one stands to the left; nothing for cameras
/// that do not look the same way, side by side.
std::string of_sides(const Camera& right) {
  constexpr double kOnePlace = 0.002;  // metres
  constexpr double kSideways = 2, kTurned = 20 * std::numbers::pi / 180;
  const Eigen::Matrix3d& turn = right.camera_from_world.linear();
  const Eigen::Vector3d at = right.camera_from_world.inverse().translation();
  if (at.norm() < kOnePlace)
    return fmt::format(
        "both cameras stand at one place ({:.2f} mm apart): are the left and the right pictures "
        "the same?",
        1000 * at.norm());
  if (-at.x() < kSideways * at.tail<2>().norm() || turn(2, 2) < std::cos(kTurned)) return {};
  return fmt::format(
      "the right camera stands {:.1f} mm to the left of the left one: are --left and --right "
      "exchanged, or all pictures mirrored or upside down?",
      -1000 * at.x());
}

}  // namespace

std::vector<std::string> faults_of(const std::vector<CommonCorners>& views, cv::Size pictures,
                                   const std::array<Lens, 2>& lenses,
                                   const StereoCalibration& calibration, int flags) {
  std::vector<std::string> out;
  const bool given = calibration.focal_sigma[0] <= 0;
  for (std::string text :
       {of_squares(stretch_of(views, pictures, lenses, flags), calibration.cameras, given),
        of_sides(calibration.cameras[1])})
    if (!text.empty()) out.push_back(std::move(text));
  return out;
}

}  // namespace hypotrack::calibrate
