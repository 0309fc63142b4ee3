#include "cuda/device_objective.cuh"

namespace hypotrack::stereo_color {

std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings) {
  return settings.lookup == Lookup::bilinear ? make_bilinear(settings)
                                             : make_with_lookup<false>(settings);
}

const char* capabilities() { return "device residuals slopes device_residuals"; }

}  // namespace hypotrack::stereo_color
