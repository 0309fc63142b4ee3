#include "evaluate/hypothesis_renderer.hpp"

#include <array>

#include "hypotrack/error.hpp"

namespace hypotrack {

HypothesisRenderer::~HypothesisRenderer() = default;

std::span<const std::string_view> enum_names(Backend) {
  static constexpr std::array<std::string_view, 3> kNames{"automatic", "cpu", "egl"};
  return kNames;
}

std::unique_ptr<HypothesisRenderer> make_hypothesis_renderer(const Scene& scene,
                                                             const EvaluateSettings& settings,
                                                             bool draws) {
  if (draws && settings.backend == Backend::egl) {
    throw DeviceError(
        "evaluate: backend egl is not in this build; use `backend: cpu` or `backend: automatic`");
  }
  return make_cpu_renderer(scene, draws, settings.threads);
}

}  // namespace hypotrack
