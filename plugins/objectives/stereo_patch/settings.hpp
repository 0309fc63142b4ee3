#pragma once

namespace hypotrack::stereo_patch {

enum class Measure { zncc, census };

/// The values of Params, for code that must not see Eigen.
struct Settings {
  Measure measure = Measure::zncc;
  int radius = 3;  ///< pixels of the tile
  double sharpness = 5;
  double variance_floor = 2e-5;
  double range = 100e-3;          ///< m
  double step = 0.5;              ///< pixels of the tile
  double r = 3e-3;                ///< m
  double full_at_difference = 0;  ///< of colours in 0..1; 0: full weight always
  bool use_mask = true;
};

}  // namespace hypotrack::stereo_patch
