#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "hand_detector.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"

/// Skips the test with a message if the hand detector's networks have not been fetched.
#define HYPOTRACK_NEEDS_HAND_DETECTOR()                                      \
  if (!std::filesystem::exists(::hypotrack::HandDetector::default_folder() / \
                               "hand_landmark_full.net"))                    \
  GTEST_SKIP() << "needs the hand detector's networks in "                   \
               << ::hypotrack::HandDetector::default_folder().string()       \
               << "; run `hypotrack get detector`"

namespace hypotrack::test {

/// One frame of a scene and the cameras it was taken with.
struct HandPictures {
  std::vector<Camera> cameras;
  Frame frame;

  const cv::Mat& picture(std::size_t view = 0) const { return frame.views[view].color; }
};

/// Returns a frame of configs/scenes/demo.yaml: one rendered right hand, open in frame 0.
HandPictures rendered_hand(int frame = 0);

/// Returns the real pair of a left hand, with its labels, from the shared data.
HandPictures stb_pair();

/// Returns each `step`th frame of the video of one hand by two webcams, from the shared data.
std::vector<HandPictures> webcam_frames(int step);

/// Returns where the true landmarks of a frame are in a view, in the order of kHandPointNames.
HandPoints true_points(const HandPictures& pictures, std::size_t view = 0);

/// Returns the mean distance of landmarks; those that are NaN in `b` do not count.
double mean_distance(const HandPoints& a, const HandPoints& b);

/// Returns the only hand in a picture; fails the test if there is none or more than one.
HandDetection only_hand(HandDetector& detector, const cv::Mat& picture);

}  // namespace hypotrack::test
