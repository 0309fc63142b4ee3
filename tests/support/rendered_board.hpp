#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::test {

/// A chessboard of 9 x 6 inner corners and 25 mm before two cameras of 320 x 240 without
/// distortion.
struct RenderedBoard {
  static constexpr double kSquare = 0.025;
  std::array<Camera, 2> cameras;

  RenderedBoard() {
    cameras[0].width = 320;
    cameras[0].height = 240;
    cameras[0].fx = cameras[0].fy = 290;
    cameras[0].cx = 163;
    cameras[0].cy = 118;
    cameras[1] = cameras[0];
    cameras[1].fx = cameras[1].fy = 296;
    cameras[1].camera_from_world.translation().x() = -0.06;
  }

  /// Returns a pose of the board: its middle in metres before the left camera, and its tilt about
  /// the picture's x and y in degrees.
  static Eigen::Isometry3d pose(const Eigen::Vector3d& middle, double about_x, double about_y) {
    constexpr double kDegree = std::numbers::pi / 180;
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.translate(middle);
    out.rotate(Eigen::AngleAxisd(about_x * kDegree, Eigen::Vector3d::UnitX()));
    out.rotate(Eigen::AngleAxisd(about_y * kDegree, Eigen::Vector3d::UnitY()));
    return out.translate(Eigen::Vector3d(-4 * kSquare, -2.5 * kSquare, 0));
  }

  /// Returns poses that fill both pictures, with all tilts and distances.
  static std::vector<Eigen::Isometry3d> poses() {
    return {pose({0.03, 0, 0.36}, 0, 0),         pose({-0.03, -0.06, 0.42}, 25, 0),
            pose({0.085, -0.06, 0.42}, 0, 28),   pose({-0.03, 0.06, 0.42}, -25, 0),
            pose({0.085, 0.06, 0.42}, 0, -28),   pose({0.02, 0, 0.56}, 20, 20),
            pose({-0.09, -0.1, 0.56}, -25, 20),  pose({0.14, -0.1, 0.56}, -20, -25),
            pose({-0.09, 0.1, 0.56}, 30, -15),   pose({0.14, 0.1, 0.56}, 15, 30),
            pose({0.03, 0.01, 0.36}, -28, -12),  pose({0.03, -0.01, 0.36}, 10, -30),
            pose({-0.02, -0.02, 0.45}, -10, 30), pose({0.09, 0.03, 0.45}, 30, 5)};
  }

  /// Draws what a camera sees of the board, 8-bit BGR.
  cv::Mat picture(std::size_t view, const Eigen::Isometry3d& world_from_board) const {
    constexpr int kPixels = 32;  // of a square
    constexpr int kFine = 4;     // samples of a pixel along each side
    const Camera& camera = cameras[view];
    const Eigen::Isometry3d pose = camera.camera_from_world * world_from_board;
    Eigen::Matrix3d lens, plane, board;
    lens << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
    plane << pose.linear().col(0), pose.linear().col(1), pose.translation();
    const double scale = kSquare / kPixels, margin = -2 * kSquare + scale / 2;
    board << scale, 0, margin, 0, scale, margin, 0, 0, 1;
    Eigen::Matrix3d fine;
    fine << kFine, 0, (kFine - 1) / 2.0, 0, kFine, (kFine - 1) / 2.0, 0, 0, 1;
    const Eigen::Matrix3d warp = fine * lens * plane * board;
    cv::Matx33d matrix;
    for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = warp(i / 3, i % 3);
    cv::Mat large, out;
    cv::warpPerspective(drawn(kPixels), large, matrix,
                        {kFine * camera.width, kFine * camera.height}, cv::INTER_LINEAR,
                        cv::BORDER_CONSTANT, cv::Scalar::all(120));
    cv::resize(large, out, {camera.width, camera.height}, 0, 0, cv::INTER_AREA);
    cv::cvtColor(out, out, cv::COLOR_GRAY2BGR);
    return out;
  }

 private:
  /// Draws the board with a white margin of a square; corner 0 is 2 squares from the edges.
  static cv::Mat drawn(int square) {
    cv::Mat1b out(9 * square, 12 * square, uchar{235});
    for (int row = 0; row < 7; ++row)
      for (int column = row % 2; column < 10; column += 2)
        out(cv::Rect((column + 1) * square, (row + 1) * square, square, square)) = 20;
    return out;
  }
};

}  // namespace hypotrack::test
