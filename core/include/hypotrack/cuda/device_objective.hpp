#pragma once

#include <array>
#include <cstdint>

#include "hypotrack/cuda/layout.hpp"
#include "hypotrack/cuda/swarm_search.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack {
struct Observation;
}

/// The `device` capability: hypotheses and costs stay in GPU memory. Plain C++, so that objectives
/// and optimizers compile without a CUDA toolkit, and without Eigen, so that .cu files can include
/// it.
namespace hypotrack::cuda {

/// A cudaStream_t.
struct Stream {
  void* handle = nullptr;
};

/// What a kernel's launch depends on.
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
  bool has_mask = false;  ///< otherwise no pixel has kForegroundFlag
};

/// A frame on the device.
struct DeviceObservation {
  /// Everything but the pixels: number, time, scene, start, cameras. Its images are empty.
  const Observation* header = nullptr;
  std::array<DeviceTile, kMaxViews> tiles;
  const FrameLayout* frame = nullptr;  ///< device memory
  bool pair = false;                   ///< as in the FrameLayout
};

/// Depth tiles of hypotheses that somebody else has drawn.
struct DrawnBatch {
  std::uint64_t texture =
      0;          ///< cudaTextureObject_t, layered, float 1/z: hypothesis * views + view
  int first = 0;  ///< hypothesis of the batch that layer 0 belongs to
  int count = 0;  ///< of hypotheses
};

/// An objective on the device. All calls come from one thread and on one stream.
class HYPOTRACK_API DeviceObjective {
 public:
  DeviceObjective() = default;
  virtual ~DeviceObjective();
  DeviceObjective(const DeviceObjective&) = delete;
  DeviceObjective& operator=(const DeviceObjective&) = delete;

  /// Enqueues what turns a frame into features. The observation outlives every enqueue() until the
  /// next prepare(). Throws DataError where Objective::prepare does.
  virtual void prepare(const DeviceObservation& observation, Stream stream) = 0;

  /// Makes room for batches of up to `count` hypotheses of the prepared frame. Throws DeviceError
  /// if the memory is not to be had.
  virtual void reserve(const SceneLayout& scene, const DeviceLimits& limits,
                       std::int64_t count) = 0;

  /// Enqueues the evaluation of a batch: poses, draws and scores. Only launches kernels, so that it
  /// can be captured into a graph.
  virtual void enqueue(const SceneLayout& scene, const BatchLayout& batch, Stream stream) = 0;

  /// Enqueues a whole search in one kernel, if it has one and all of it fits on the device at once;
  /// after reserve() for a batch of the search's particles. `batch` says how points are read and
  /// what their costs are weighed with. False: nothing was enqueued.
  virtual bool enqueue_search(const SceneLayout& scene, const BatchLayout& batch,
                              const SwarmSearch& search, Stream stream);

  /// Whether enqueue_residuals() is there; the same before and after every prepare().
  virtual bool has_residuals() const { return false; }
  /// ResidualTerm::residual_count() of the prepared frame.
  virtual std::int64_t residual_count() const { return 0; }
  /// The same as enqueue(), and writes the residuals that ResidualTerm::write_residuals() writes on
  /// the CPU, in its order, every one of them. Throws Error if there are none.
  virtual void enqueue_residuals(const SceneLayout& scene, const BatchLayout& batch,
                                 const ResidualLayout& residuals, Stream stream);

  /// Enqueues the scoring of hypotheses that are drawn already.
  virtual void enqueue_drawn(const SceneLayout& scene, const BatchLayout& batch,
                             const DrawnBatch& drawn, Stream stream) = 0;

  /// Changes whenever enqueue() would launch kernels with other arguments than before, so that a
  /// captured graph is no longer valid.
  virtual std::uint64_t revision() const = 0;
};

}  // namespace hypotrack::cuda
