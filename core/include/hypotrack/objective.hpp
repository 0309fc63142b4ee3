#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "hypotrack/export.hpp"
#include "hypotrack/observation.hpp"

namespace hypotrack {

namespace cuda {
class DeviceObjective;
}

/// Depth of one hypothesis as one view sees it.
struct DepthTile {
  int width = 0;
  int height = 0;
  int stride = 0;                        ///< floats per row, >= width; rows may be read to `stride`
  const float* inverse_depth = nullptr;  ///< 1/z in 1/m of the nearest surface; 0: not covered
  /// Bounds of what may be covered: x0 <= x < x1, y0 <= y < y1. Outside it everything is 0.
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// One hypothesis, posed and drawn.
struct RenderedHypothesis {
  std::span<const double> state;     ///< normalised, Scene::dimension() numbers
  std::span<const DepthTile> views;  ///< one per view; empty if no objective needs rendering
};

/// An objective as a sum of squares, for optimizers of least squares.
class HYPOTRACK_API ResidualTerm {
 public:
  ResidualTerm() = default;
  virtual ~ResidualTerm();
  ResidualTerm(const ResidualTerm&) = delete;
  ResidualTerm& operator=(const ResidualTerm&) = delete;

  /// Number of residuals of every hypothesis of the prepared frame; may be 0.
  virtual std::int64_t residual_count() const = 0;

  /// Writes the residuals of a hypothesis, `residual_count()` finite numbers. One place belongs to
  /// one pixel (joint, pair of spheres), whatever the hypothesis, so that the residuals of two
  /// hypotheses can be subtracted. Best, the sum of their squares is the cost plus a constant of
  /// the frame; where the cost is no sum of squares, they are small where it is low. Called from
  /// several threads at once; equal inputs give equal results.
  virtual void write_residuals(const RenderedHypothesis& hypothesis,
                               std::span<float> residuals) const = 0;

  /// Whether all residuals belong to pixels, and pixel_views() and write_slopes() say how. The same
  /// before and after every `prepare`.
  virtual bool has_slopes() const { return false; }

  /// Views whose pixels the residuals of the prepared frame belong to, in the order of the
  /// residuals: one per pixel of the view's tile, rows without gaps. Only with has_slopes().
  virtual std::span<const int> pixel_views() const;

  /// The residuals of the i-th of pixel_views(), and how each of them changes with the surface that
  /// is drawn at its pixel: d r / d(1/z) in metres, 0 where nothing is drawn. That is all that
  /// optimizers need of a term to have its Jacobian: how surfaces and silhouettes move is known
  /// without it. Differences over half a pixel of what is looked up make better slopes than
  /// derivatives at a point: pixels are noisy. Called from several threads at once.
  virtual void write_slopes(const RenderedHypothesis& hypothesis, std::size_t i,
                            std::span<float> residuals, std::span<float> slopes) const;
};

/// What an objective looks at of a view beside its colours.
struct ImageUse {
  bool mask = true;
  bool depth = true;
};

/// Says how badly a hypothesis explains a frame. A scene adds several up with weights.
class HYPOTRACK_API Objective {
 public:
  Objective() = default;
  virtual ~Objective();
  Objective(const Objective&) = delete;
  Objective& operator=(const Objective&) = delete;

  /// False for a term that looks at the state only (joint limits, priors); it costs no rendering.
  virtual bool needs_rendering() const { return true; }

  /// Images that no objective of a scene looks at may be missing from what `prepare` gets, although
  /// the frame has them: they need not be cut, nor uploaded to a GPU.
  virtual ImageUse image_use() const { return {}; }

  /// Takes the frame in: features and whatever makes scoring cheap. The observation outlives every
  /// `cost` until the next `prepare`. Throws DataError if it cannot work with what it is given (one
  /// view for a stereo objective).
  virtual void prepare(const Observation& observation) = 0;

  /// Cost of a hypothesis: lower is better, +infinity is infeasible, NaN is a bug. Called from
  /// several threads at once; equal inputs give equal results.
  virtual double cost(const RenderedHypothesis& hypothesis) const = 0;

  /// The same objective as a sum of squares; null if it has none, before and after every `prepare`.
  /// Lives as long as this one (an objective may derive from ResidualTerm and return itself).
  virtual const ResidualTerm* residual_term() const;

  /// What cost() returns (up to rounding) and residual_term()->write_residuals() writes, for
  /// objectives that have residuals. Worth overriding where one walk over the pixels gives both.
  virtual double cost_and_residuals(const RenderedHypothesis& hypothesis,
                                    std::span<float> residuals) const;

  /// The same objective for the GPU (hypotrack/cuda/device_objective.hpp), null if it has none or
  /// was built without CUDA: then scenes with it are evaluated on the CPU. Outlived by this one.
  virtual std::unique_ptr<cuda::DeviceObjective> on_device() const;
};

}  // namespace hypotrack
