#pragma once

#include <memory>

namespace hypotrack {
namespace cuda {
class DeviceObjective;
}
}  // namespace hypotrack

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

/// Makes the objective on the GPU; null in a build without CUDA. Does not touch the device before
/// it prepares a frame.
std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings);

/// Returns the capabilities for `plugins info`; the GPU's only in a build with CUDA.
const char* capabilities();

/// Planes of the sweep: inverse depths first + k step of the reference view, 0 <= k < count. In a
/// rectified pair they are equidistant in disparity.
struct Planes {
  float first = 0;  ///< 1/m
  float step = 0;   ///< 1/m
  int count = 0;    ///< 2 or more
};

}  // namespace hypotrack::stereo_patch
