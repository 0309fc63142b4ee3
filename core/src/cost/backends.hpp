#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Makes the cost that draws with a HypothesisRenderer and scores on the CPU. `why_here` is the
/// reason for not using a GPU; its backend() includes it.
std::unique_ptr<Cost> make_host_cost(const Scene& scene, std::vector<ObjectiveTerm> terms,
                                     const EvaluateSettings& settings, std::string why_here = {});

/// Throws Error that says what a term did wrong for a hypothesis (`adds an infinity to its
/// opposite`).
[[noreturn]] void refuse_cost(const ObjectiveTerm& term, Eigen::Index index, const char* what);

/// Throws Error unless there is room for rows x columns residuals.
void check_room(const Eigen::Ref<const Eigen::MatrixXf>& residuals, Eigen::Index rows,
                Eigen::Index columns);

}  // namespace internal
}  // namespace hypotrack

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns why the settings' GPU cannot evaluate these terms, with `residuals` if true; empty if it
/// can.
std::string why_not_evaluated(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                              const EvaluateSettings& settings, bool residuals);

/// Returns why no term that needs rendering has slopes on a GPU; empty if one has, or none needs
/// it.
std::string why_not_linearized(const std::vector<ObjectiveTerm>& terms);

/// Returns why Jacobians on a GPU take a drawing per parameter; empty if they take one in all.
std::string why_neighbours_are_drawn(const std::vector<ObjectiveTerm>& terms);

/// Makes the cost that poses, draws and scores on the GPU. Throws DeviceError with the reason of
/// why_not_evaluated(), if there is one.
std::unique_ptr<Cost> make_cost(const Scene& scene, std::vector<ObjectiveTerm> terms,
                                const EvaluateSettings& settings, bool residuals);

/// Makes the paper's cost: OpenGL draws a batch of hypotheses into the layers of a texture, CUDA
/// scores them there, and costs are downloaded. Returns null, with the reason in `why_not`, if
/// there is no device, an objective has no device capability, or OpenGL uses another GPU. Throws
/// DeviceError if there is no OpenGL.
std::unique_ptr<Cost> make_egl_cost(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                                    const EvaluateSettings& settings, std::string& why_not);

}  // namespace internal
}  // namespace hypotrack::cuda
