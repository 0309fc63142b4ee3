#pragma once

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "calibrate/stereo_calibration.hpp"

namespace hypotrack::calibrate {

/// Two cameras, and pairs of a board in front of them.
class StereoCalibrationTest : public testing::Test {
 protected:
  StereoCalibrationTest() {
    cameras_[0] = {640, 480, 530, 531, 325, 238, DistortionModel::brown, {-0.25, 0.1, 0.001, 0, 0},
                   {}};
    cameras_[0].camera_from_world.setIdentity();
    cameras_[1] = cameras_[0];
    cameras_[1].fx = 545;
    cameras_[1].camera_from_world.linear() =
        Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()).matrix();
    cameras_[1].camera_from_world.translation() << -0.09, 0.002, 0.001;
  }

  /// Returns pairs in which corners are off by noise of `sigma` pixels.
  std::vector<BoardPair> pairs(int count, double sigma, double tilt = 0.5) {
    std::vector<BoardPair> out;
    while (static_cast<int>(out.size()) < count) {
      Eigen::Isometry3d pose(Eigen::AngleAxisd(tilt * normal_(random_), Eigen::Vector3d::UnitX()) *
                             Eigen::AngleAxisd(tilt * normal_(random_), Eigen::Vector3d::UnitY()));
      pose.pretranslate(Eigen::Vector3d(-0.1 + 0.08 * normal_(random_),
                                        -0.06 + 0.06 * normal_(random_),
                                        0.45 + 0.05 * normal_(random_)));
      BoardPair pair{"pair " + std::to_string(out.size()), {}};
      bool visible = true;
      for (std::size_t view = 0; view < 2; ++view)
        for (int id = 0; id < 54; ++id) {
          const cv::Point3f place = finder_.place(id);
          const Eigen::Vector2d at =
              project(cameras_[view], pose * Eigen::Vector3d(stretch_ * place.x, place.y, place.z));
          visible = visible && at.x() > 0 && at.y() > 0 && at.x() < 640 && at.y() < 480;
          pair.corners[view].sigma = sharpness_;
          pair.corners[view].ids.push_back(id);
          pair.corners[view].at.emplace_back(static_cast<float>(at.x() + sigma * normal_(random_)),
                                             static_cast<float>(at.y() + sigma * normal_(random_)));
        }
      if (visible) out.push_back(std::move(pair));
    }
    return out;
  }

  StereoCalibration calibrated(const std::vector<BoardPair>& pairs) {
    return calibrate_stereo(finder_, {640, 480}, pairs);
  }

  BoardFinder finder_{parse_board("9x6", "25mm")};
  std::array<Camera, 2> cameras_;
  double stretch_ = 1;    ///< of the squares, along the rows of the board
  double sharpness_ = 0;  ///< expected standard deviation of corners; 0: unknown
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

}  // namespace hypotrack::calibrate
