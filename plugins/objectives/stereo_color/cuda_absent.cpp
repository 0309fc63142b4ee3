// Stands in for cuda/ in a build without a CUDA toolkit.
#include "hypotrack/gpu/device_objective.hpp"
#include "settings.hpp"

namespace hypotrack::stereo_color {

std::unique_ptr<cuda::DeviceObjective> make_device_objective(const Settings&) { return nullptr; }
const char* capabilities() { return "residuals slopes"; }

}  // namespace hypotrack::stereo_color
