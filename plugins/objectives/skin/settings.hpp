#pragma once

#include <memory>

namespace hypotrack {
namespace cuda {
class DeviceObjective;
}
}  // namespace hypotrack

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

/// Makes the objective on the GPU; null in a build without CUDA. Does not touch the device before
/// it prepares a frame.
std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings);

/// Returns the capabilities for `plugins info`; the GPU's only in a build with CUDA.
const char* capabilities();

}  // namespace hypotrack::skin
