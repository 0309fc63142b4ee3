#pragma once

#include <memory>

namespace hypotrack {
namespace cuda {
class DeviceObjective;
}
}  // namespace hypotrack

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

/// Makes the objective on the GPU; null in a build without CUDA. Does not touch the device before
/// it prepares a frame.
std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings);

/// Returns the capabilities for `plugins info`; the GPU's only in a build with CUDA.
const char* capabilities();

}  // namespace hypotrack::rgbd_depth
