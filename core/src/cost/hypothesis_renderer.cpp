#include "cost/hypothesis_renderer.hpp"

#include <array>

namespace hypotrack {

HypothesisRenderer::~HypothesisRenderer() = default;

std::span<const std::string_view> enum_names(Backend) {
  static constexpr std::array<std::string_view, 4> kNames{"auto", "cpu", "egl", "cuda"};
  return kNames;
}

std::unique_ptr<HypothesisRenderer> make_hypothesis_renderer(const Scene& scene,
                                                             const EvaluateSettings& settings,
                                                             bool draws) {
  if (draws && settings.backend == Backend::egl) return make_egl_renderer(scene, settings.threads);
  return make_cpu_renderer(scene, draws, settings.threads);
}

}  // namespace hypotrack
