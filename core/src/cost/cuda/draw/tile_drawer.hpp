#pragma once

#include <cstdint>

#include "base/exported.hpp"
#include "hypotrack/gpu/block_memory.cuh"
#include "hypotrack/gpu/device_objective.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Draws hypotheses into device memory, once for all terms.
class TileDrawer {
 public:
  void prepare(const DeviceObservation& observation);

  /// Allocates memory for batches of up to `count` hypotheses of the prepared frame. Throws
  /// DeviceError if there is not enough.
  void reserve(const SceneLayout& scene, const DeviceLimits& limits, std::int64_t count);

  /// Returns how many hypotheses of the prepared frame are drawn at once, at most.
  std::int64_t most_at_once() const;
  /// Returns how many hypotheses fit into the memory at once.
  std::int64_t at_once() const { return at_once_; }
  /// Returns the number of pixels of all views.
  std::int64_t pixels() const { return pixels_; }

  /// Enqueues the drawing of `count` hypotheses of a batch, at most at_once(). The result is valid
  /// until the next call. Sets the hypotheses' costs to 0.
  DrawnBatch enqueue(const SceneLayout& scene, const BatchLayout& batch, std::int64_t first,
                     std::int64_t count, Stream stream);

  /// See DeviceObjective::revision().
  std::uint64_t revision() const { return revision_ + memory_.revision(); }

 private:
  const FrameLayout* frame_ = nullptr;
  bool pair_ = false;
  int view_count_ = 0, width_ = 0, height_ = 0;  // of the widest and of the highest view
  int before_[kMaxViews] = {}, widths_[kMaxViews] = {}, heights_[kMaxViews] = {};
  std::int64_t pixels_ = 0;
  std::int64_t reserved_ = 0, at_once_ = 0;
  std::uint64_t revision_ = 0;
  DeviceLimits limits_;
  BlockPlan plan_;
  BlockMemory memory_;
  DeviceBuffer<float> depth_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
