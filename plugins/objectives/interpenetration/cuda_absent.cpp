// Stands in for device_objective.cu in a build without CUDA.
#include "collision_term.hpp"

namespace hypotrack::interpenetration {
std::unique_ptr<cuda::DeviceObjective> on_device(const CollisionTerm&) { return nullptr; }
const char* capabilities() { return "residuals"; }
}  // namespace hypotrack::interpenetration
