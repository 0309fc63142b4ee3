#pragma once

namespace hypotrack::rgbd_depth {

enum class Foreground { automatic, mask, depth, skin };

/// The values of Params, for code that must not see Eigen.
struct Settings {
  double d_max = 40e-3;    ///< m
  double d_match = 10e-3;  ///< m
  double lambda = 20;
  double lambda_k = 10;
  Foreground foreground = Foreground::automatic;
  double range = 100e-3;  ///< m
};

}  // namespace hypotrack::rgbd_depth
