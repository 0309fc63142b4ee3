#include "cuda/device_objective.cuh"

namespace hypotrack::stereo_color {

std::unique_ptr<cuda::DeviceObjective> make_bilinear(const Settings& settings) {
  return make_with_lookup<true>(settings);
}

}  // namespace hypotrack::stereo_color
