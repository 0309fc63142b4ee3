#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cost/evaluation.hpp"

namespace hypotrack::cuda {

/// Makes the paper's evaluation: OpenGL draws a batch of hypotheses into the layers of a texture,
/// CUDA scores them there, and costs are downloaded. Returns null, with the reason in `why_not`, if
/// there is no device, an objective has no device capability, or OpenGL uses another GPU. Throws
/// DeviceError if there is no OpenGL.
std::unique_ptr<Evaluation> make_egl_evaluation(const Scene& scene,
                                                const std::vector<ObjectiveTerm>& terms,
                                                const EvaluateSettings& settings,
                                                std::string& why_not);

}  // namespace hypotrack::cuda
