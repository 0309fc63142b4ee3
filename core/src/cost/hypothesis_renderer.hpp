#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>

#include "cost/evaluator.hpp"
#include "hypotrack/objective.hpp"
#include "hypotrack/observation.hpp"
#include "hypotrack/scene.hpp"

namespace hypotrack {

/// What draws hypotheses: the seam between the evaluator and its backends. An implementation is one
/// source file with a make_* function (below) that make_hypothesis_renderer() calls.
class HYPOTRACK_API HypothesisRenderer {
 public:
  /// Receives hypothesis `index`; the spans in it are valid until it returns. May be called from
  /// several threads at once; what it throws comes out of render() unchanged.
  using Visit = std::function<void(Eigen::Index index, const RenderedHypothesis& hypothesis)>;

  HypothesisRenderer() = default;
  virtual ~HypothesisRenderer();
  HypothesisRenderer(const HypothesisRenderer&) = delete;
  HypothesisRenderer& operator=(const HypothesisRenderer&) = delete;

  /// Takes the cameras of a frame's tiles. The observation outlives every `render` until the next
  /// `prepare`.
  virtual void prepare(const Observation& observation) = 0;

  /// Poses and draws every column of `states` (DxN, normalised by Scene::normalize) in every view
  /// and calls `visit` exactly once for each column, in any order. If a call throws, the rest of
  /// the batch may be left out and one of the exceptions is rethrown. One batch at a time.
  virtual void render(const Eigen::MatrixXd& states, const Visit& visit) = 0;

  /// For Evaluator::backend(): `cpu (AVX3, 2 threads)`.
  virtual std::string description() const = 0;
};

/// The SIMD rasteriser, `threads` of them side by side (0: one per core). With `draws` false it
/// only hands the states on, over the same threads, with empty views: for terms that need no
/// picture.
HYPOTRACK_API std::unique_ptr<HypothesisRenderer> make_cpu_renderer(const Scene& scene, bool draws,
                                                                    int threads);

/// OpenGL on a surfaceless EGL context; hypotheses are handed on over `threads` (0: one per core).
/// Throws DeviceError if there is no OpenGL.
HYPOTRACK_API std::unique_ptr<HypothesisRenderer> make_egl_renderer(const Scene& scene,
                                                                    int threads);

/// The renderer that the settings ask for. Throws DeviceError if it is not to be had; never a
/// silent substitute. `draws` false: no term needs pictures, so none are made and no device is
/// opened.
HYPOTRACK_API std::unique_ptr<HypothesisRenderer> make_hypothesis_renderer(
    const Scene& scene, const EvaluateSettings& settings, bool draws);

}  // namespace hypotrack
