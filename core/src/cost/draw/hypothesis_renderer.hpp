#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/objective.hpp"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Draws hypotheses for the cost that scores on the CPU. An implementation is one source file with
/// a make_* function (below).
class HypothesisRenderer {
 public:
  /// Receives hypothesis `index`; its spans are valid until it returns. May be called from several
  /// threads at once. render() passes its exceptions on unchanged.
  using Visit = std::function<void(Eigen::Index index, const RenderedHypothesis& hypothesis)>;

  HypothesisRenderer() = default;
  virtual ~HypothesisRenderer();
  HypothesisRenderer(const HypothesisRenderer&) = delete;
  HypothesisRenderer& operator=(const HypothesisRenderer&) = delete;

  /// Sets the cameras of a frame's tiles. The observation outlives every `render` until the next
  /// `prepare`.
  virtual void prepare(const Observation& observation) = 0;

  /// Poses and draws every column of `states` (DxN, normalised by Scene::normalize) in every view.
  /// Calls `visit` once per column, in any order. If a call throws, render() may skip the rest of
  /// the batch and rethrows one of the exceptions. One batch at a time.
  virtual void render(const Eigen::MatrixXd& states, const Visit& visit) = 0;

  /// Returns the text of Cost::backend(): `cpu (AVX3, 2 threads)`.
  virtual std::string description() const = 0;
};

/// Makes the SIMD rasteriser with `threads` threads (0: one per core). If `draws` is false, it only
/// passes on the states, on the same threads, with empty views, for terms that need no rendering.
std::unique_ptr<HypothesisRenderer> make_cpu_renderer(const Scene& scene, bool draws, int threads);

/// Makes the OpenGL renderer on a surfaceless EGL context; `threads` threads visit hypotheses (0:
/// one per core). Throws DeviceError if there is no OpenGL.
std::unique_ptr<HypothesisRenderer> make_egl_renderer(const Scene& scene, int threads);

}  // namespace internal
}  // namespace hypotrack
