#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cost/evaluation.hpp"

namespace hypotrack::cuda {

/// The paper's way: OpenGL draws hypotheses into the layers of a texture, all of a batch at once,
/// and CUDA scores them there; costs come down. Null where that cannot be, and `why_not` then has
/// the reason: no device, an objective without the device capability, OpenGL on another GPU. Throws
/// DeviceError if there is no OpenGL.
std::unique_ptr<Evaluation> make_egl_evaluation(const Scene& scene,
                                                const std::vector<ObjectiveTerm>& terms,
                                                const EvaluateSettings& settings,
                                                std::string& why_not);

}  // namespace hypotrack::cuda
