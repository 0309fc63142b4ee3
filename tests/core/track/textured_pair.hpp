#pragma once

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <vector>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "track/faults/picture_checks.hpp"

namespace hypotrack::test {

/// A textured wall and a textured patch before it, seen by a rectified pair of cameras.
class TexturedPair {
 public:
  static constexpr int kWidth = 640, kHeight = 360;
  static constexpr int kWall = 42, kPatch = 84;  // disparities of 1 and 0.5 m
  static constexpr int kSide = 120;              // of the patch, pixels

  TexturedPair() {
    const Camera camera{kWidth, kHeight, 350, 350, 319.5, 179.5, DistortionModel::none, {}, {}};
    cameras = {camera, camera};
    for (Camera& c : cameras) c.camera_from_world.setIdentity();
    cameras[1].camera_from_world.translation().x() = -0.12;
    wall_ = texture(3 * kWidth, kHeight, 1);
    patch_ = texture(kSide, kSide, 2);
  }

  static constexpr int kTop = (kHeight - kSide) / 2;

  /// A frame with the patch's left edge at this x of the first view; outside: without the patch.
  Frame frame(int x, int wall = kWall, int patch = kPatch, int y = kTop) const {
    Frame out;
    out.index = 0;
    out.views = {View{picture(0, x, y)}, View{picture(wall, x - patch, y)}};
    return out;
  }

  std::vector<Camera> cameras;

 private:
  static cv::Mat texture(int width, int height, std::uint64_t seed) {
    constexpr int kCoarse = 14;
    cv::Mat small(height / kCoarse + 1, width / kCoarse + 1, CV_8UC3), out;
    cv::RNG random(seed);
    random.fill(small, cv::RNG::UNIFORM, 40, 180);
    cv::resize(small, out, {width, height}, 0, 0, cv::INTER_CUBIC);
    return out;
  }

  cv::Mat picture(int shift, int x, int y) const {
    cv::Mat out = wall_(cv::Rect(kWidth + shift, 0, kWidth, kHeight)).clone();
    const cv::Rect place = cv::Rect(x, y, kSide, kSide) & cv::Rect(0, 0, kWidth, kHeight);
    if (!place.empty()) patch_(place - cv::Point(x, y)).copyTo(out(place));
    return out;
  }

  cv::Mat wall_, patch_;
};

/// Adds normal noise to all pictures, as a sensor does.
inline Frame noisy(Frame frame, double sigma, std::uint64_t seed) {
  cv::RNG random(seed);
  for (View& view : frame.views) {
    cv::Mat noise(view.color.size(), CV_16SC3), sum;
    random.fill(noise, cv::RNG::NORMAL, 0, sigma);
    cv::add(view.color, noise, sum, cv::noArray(), CV_8U);
    view.color = sum;
  }
  return frame;
}

/// Tests of what PictureChecks finds in frames of a textured pair.
class TexturedPairChecks : public ::testing::Test {
 protected:
  FrameFault check(const Frame& frame) {
    last_ = checks_.check(frame);
    return last_.fault;
  }
  /// Checks the frames of a patch that moves by `step` pixels per frame.
  void expect_sound(int first, int step, int frames) {
    for (int i = 0; i < frames; ++i)
      EXPECT_EQ(check(pair_.frame(first + i * step)), FrameFault::none) << "frame " << i;
  }

  TexturedPair pair_;
  PictureChecks checks_{pair_.cameras, false};
  ViewFault last_;
};

}  // namespace hypotrack::test
