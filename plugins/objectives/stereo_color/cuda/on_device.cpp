#include "cuda/lookups.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_color {

std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings& settings) {
  return settings.lookup == Lookup::bilinear ? make_bilinear(settings) : make_nearest(settings);
}

const char* capabilities() { return "device residuals slopes device_residuals"; }

}  // namespace hypotrack::stereo_color
