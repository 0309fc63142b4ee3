#pragma once

namespace hypotrack::skin {

enum class Foreground { automatic, color, mask, depth };

/// The values of Params, for code that must not see Eigen.
struct Settings {
  Foreground foreground = Foreground::automatic;
  int learn_frames = 1;
  double pose_error = 10e-3;  ///< m
  double guess_trust = 0.4;
  double spill = 1;
  double range = 100e-3;  ///< m
  bool still_cameras = false;
};

}  // namespace hypotrack::skin
