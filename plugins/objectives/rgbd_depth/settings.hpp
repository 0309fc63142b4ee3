#pragma once

#include <memory>

namespace hypotrack {
struct Observation;
namespace cuda {
class DeviceObjective;
struct DeviceObservation;
}  // namespace cuda
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

/// Throws DataError unless the views fit the objective. At least one view must have depth. Every
/// view with depth must have what `foreground` needs, in images of its tile's size and of the right
/// type.
void check(const Observation& observation, Foreground foreground);
/// Checks a frame on the device, whose images always have the right size and type. Throws DataError
/// as above.
void check(const cuda::DeviceObservation& observation, Foreground foreground);

}  // namespace hypotrack::rgbd_depth
