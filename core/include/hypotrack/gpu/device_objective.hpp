#pragma once

#include <array>
#include <cstdint>

#include "hypotrack/api/export.hpp"
#include "hypotrack/gpu/layout.hpp"
#include "hypotrack/gpu/swarm_search.hpp"

namespace hypotrack {
struct Observation;
}

/// The `device` capability: hypotheses and costs stay in GPU memory. Plain C++ without Eigen:
/// objectives and optimizers compile without a CUDA toolkit, and .cu files can include it.
namespace hypotrack::cuda {

/// A cudaStream_t.
struct Stream {
  void* handle = nullptr;
};

/// Device properties that a kernel's launch depends on.
struct DeviceLimits {
  int multiprocessors = 0;
  int compute_capability = 0;      ///< 90 for 9.0
  int shared_bytes_per_block = 0;  ///< with opt-in
  int shared_bytes_per_multiprocessor = 0;
};

/// One view's tile on the device.
struct DeviceTile {
  TileLayout layout{};
  bool has_color = false;
  bool has_mask = false;  ///< if false, no pixel has kForegroundFlag
};

/// A frame on the device.
struct DeviceObservation {
  /// The observation without pixels: number, time, scene, start, cameras. Its images are empty.
  const Observation* header = nullptr;
  std::array<DeviceTile, kMaxViews> tiles;
  const FrameLayout* frame = nullptr;  ///< device memory
  bool pair = false;                   ///< as in the FrameLayout
};

/// Depth tiles (float 1/z, 0 where nothing is drawn) of drawn hypotheses: in a texture or in device
/// memory.
struct DrawnBatch {
  std::uint64_t texture = 0;  ///< cudaTextureObject_t, layered: hypothesis * views + view; or 0
  int first = 0;              ///< the first drawn hypothesis of the batch
  int count = 0;              ///< number of hypotheses
  /// Without a texture: the tiles of all views, one after the other, row by row without gaps.
  const float* depth = nullptr;
  std::int64_t stride = 0;  ///< from one hypothesis to the next
};

/// A pixel's residual and its slope d residual / d(1/z), in metres.
struct alignas(8) PixelSlope {
  float residual, slope;
};

/// Memory for an objective's slopes of drawn hypotheses.
struct SlopeLayout {
  PixelSlope* pixels;   ///< of all views, one after the other, row by row without gaps
  std::int64_t stride;  ///< from one hypothesis to the next
  float factor;         ///< factor on residuals and slopes: the root of the objective's weight
};

/// An objective on the GPU. All calls come from one thread. Those that enqueue work with hypotheses
/// only launch kernels, so that a CUDA graph can capture them, on any of a few streams.
class HYPOTRACK_API DeviceObjective {
 public:
  DeviceObjective() = default;
  virtual ~DeviceObjective();
  DeviceObjective(const DeviceObjective&) = delete;
  DeviceObjective& operator=(const DeviceObjective&) = delete;

  /// Enqueues the kernels that prepare a frame's features. The observation outlives every enqueue()
  /// until the next prepare(). Throws DataError where Objective::prepare does.
  virtual void prepare(const DeviceObservation& observation, Stream stream) = 0;

  /// Allocates memory for batches of up to `count` hypotheses of the prepared frame. Throws
  /// DeviceError if there is not enough.
  virtual void reserve(const SceneLayout& scene, const DeviceLimits& limits,
                       std::int64_t count) = 0;

  /// Returns true if enqueue() poses and draws; the answer never changes. Otherwise hypotheses are
  /// drawn for enqueue_drawn(), whose kernels see whole tiles: a pixel and its neighbours.
  virtual bool draws() const { return true; }

  /// Enqueues the evaluation of a batch: posing, drawing and scoring. Throws Error unless draws().
  virtual void enqueue(const SceneLayout& scene, const BatchLayout& batch, Stream stream);

  /// Enqueues a whole search as one kernel, if the objective has one and all blocks fit on the
  /// device at once. Returns false if it enqueued nothing. reserve() must precede it, with the
  /// search's number of particles. `batch` defines how points are read and how costs are weighted.
  virtual bool enqueue_search(const SceneLayout& scene, const BatchLayout& batch,
                              const SwarmSearch& search, Stream stream);

  /// Returns true if enqueue_residuals() is available; the answer never changes.
  virtual bool has_residuals() const { return false; }
  /// Returns ResidualTerm::residual_count() of the prepared frame.
  virtual std::int64_t residual_count() const { return 0; }

  /// Enqueues the scoring of drawn hypotheses. An objective of the state ignores what is drawn.
  virtual void enqueue_drawn(const SceneLayout& scene, const BatchLayout& batch,
                             const DrawnBatch& drawn, Stream stream) = 0;
  /// Scores like enqueue_drawn() and writes all residuals, in the order of
  /// ResidualTerm::write_residuals(). Throws Error if there are none.
  virtual void enqueue_residuals(const SceneLayout& scene, const BatchLayout& batch,
                                 const DrawnBatch& drawn, const ResidualLayout& residuals,
                                 Stream stream);

  /// Returns true if enqueue_slopes() is available; the answer never changes.
  virtual bool has_slopes() const { return false; }
  /// Enqueues the computation of ResidualTerm::write_slopes() for drawn hypotheses. Pixels without
  /// a residual get 0. Throws Error if there are none.
  virtual void enqueue_slopes(const SceneLayout& scene, const DrawnBatch& drawn,
                              const SlopeLayout& slopes, Stream stream);

  /// Returns a number that changes whenever enqueue(), or another function that enqueues work with
  /// hypotheses, would launch other kernels or arguments. Captured graphs are then invalid.
  virtual std::uint64_t revision() const = 0;
};

}  // namespace hypotrack::cuda
