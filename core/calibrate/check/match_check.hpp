#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "hypotrack/api/camera.hpp"

namespace hypotrack::calibrate {

/// Points that agree with a calibration.
struct MatchedPoints {
  std::array<std::vector<cv::Point2f>, 2> pixels;  ///< in both pictures
  std::vector<double> depths;                      ///< before the left camera, metres
  bool flat = false;                               ///< nearly all lie on one plane
};

/// How well matches between pictures of two cameras agree with their calibration.
struct MatchCheck {
  int matches = 0;        ///< pairs of features that look alike
  double offset = 0;      ///< median distance from the epipolar line with its sign, pixels
  double distance = 0;    ///< median distance from the epipolar line, pixels
  double consistent = 0;  ///< share of the matches that lie in front of both cameras, near the line
  /// The same share with left and right exchanged.
  double consistent_exchanged = 0;
  MatchedPoints points;  ///< the consistent ones

  /// Returns whether the pictures seem to be exchanged.
  bool looks_exchanged() const;
};

/// Compares features (SIFT: Lowe 2004) of two 8-bit pictures with the cameras' epipolar lines.
MatchCheck check_matches(const std::array<Camera, 2>& cameras, const cv::Mat& left,
                         const cv::Mat& right);

}  // namespace hypotrack::calibrate
