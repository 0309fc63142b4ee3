// Stands in for device_objective.cu in a build without CUDA.
#include "motion_term.hpp"

namespace hypotrack::plausible_motion {
std::unique_ptr<cuda::DeviceObjective> on_device(TermOfFrame) { return nullptr; }
const char* capabilities() { return "residuals jacobian"; }
}  // namespace hypotrack::plausible_motion
