#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "cost/cuda/device.hpp"
#include "cost/cuda/draw/device_scene.hpp"
#include "cost/cuda/draw/tile_drawer.hpp"
#include "cost/cuda/side_stream.hpp"
#include "cost/cuda/tiles/tile_upload.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// A frame on the GPU and the terms that score its hypotheses, on one stream and others beside it.
class FrameOnDevice {
 public:
  /// All terms must have a device objective. Throws DeviceError if the GPU or the scene is
  /// unusable.
  FrameOnDevice(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                const EvaluateSettings& settings);
  ~FrameOnDevice();
  FrameOnDevice(const FrameOnDevice&) = delete;
  FrameOnDevice& operator=(const FrameOnDevice&) = delete;

  const Device& device() const { return device_; }
  Stream stream() const { return device_.stream(); }
  const std::vector<ObjectiveTerm>& terms() const { return terms_; }

  /// Makes the GPU the calling thread's and waits for the previous frame's work. Its uploads may
  /// still read staging memory if the frame was never searched or its search failed.
  void finish();

  /// Uploads a frame whose tiles are on the CPU; call finish() first.
  void prepare(const Observation& observation);
  /// Prepares a frame whose tiles are already on the GPU.
  void prepare(const DeviceObservation& observation);

  /// Allocates memory for batches of `count` hypotheses. If there is too little, throws
  /// DeviceError, which says how many would fit.
  void reserve(std::int64_t count);
  /// Allocates memory for batches of `count` hypotheses, and calls `more` to allocate whatever else
  /// such a batch needs.
  void reserve(std::int64_t count, const std::function<void(std::int64_t)>& more);

  /// Enqueues all terms for a batch; sets `batch.weight` and `batch.add`. Several terms that need
  /// rendering share one drawing of each hypothesis.
  void enqueue(BatchLayout batch);
  /// Returns how many costs enqueue_apart() gives each of so many hypotheses.
  int cost_sets(std::int64_t count) const;
  /// Enqueues all terms for a batch as enqueue() does. Terms of few hypotheses run at the same
  /// time, each with a set of costs of its own, in their order. A last set is 0 where hypotheses
  /// are drawn for several terms.
  void enqueue_apart(const BatchLayout& batch);
  /// Waits for the work beside the stream, after an error.
  void end_sides() const;
  /// Enqueues a whole search, which only a single term can run (DeviceCost::enqueue_search()). Sets
  /// `batch.weight`.
  bool enqueue_search(BatchLayout batch, const SwarmSearch& search);
  /// Enqueues all terms with their residuals: residual_count() per hypothesis, term after term,
  /// each times the root of its weight. The terms must be a sum of squares (TermResiduals).
  void enqueue(BatchLayout batch, float* residuals);
  /// Enqueues all terms for hypotheses that are already drawn.
  void enqueue_drawn(BatchLayout batch, const DrawnBatch& drawn);
  /// Draws a batch of at most drawn_at_once() hypotheses. Sets their costs to 0.
  DrawnBatch draw(const BatchLayout& batch);
  /// Enqueues beside the stream the slopes of the terms that have them: sloped_terms() x pixels()
  /// per drawn hypothesis. Work enqueued after join_slopes() waits for them.
  void fork_slopes(const DrawnBatch& drawn, PixelSlope* slopes);
  void join_slopes();
  /// Enqueues the residuals of the terms without slopes: difference_residual_count() per
  /// hypothesis, each times the root of its weight. Sets the costs to those of these terms. If one
  /// of them needs rendering (draws_differences()), `stream` must be that of this frame.
  void enqueue_differences(BatchLayout batch, float* residuals, Stream stream);

  const SceneLayout& scene() const { return scene_.layout(); }
  const DeviceObservation& observation() const { return observation_; }
  int view_count() const { return static_cast<int>(observation_.header->views.size()); }
  /// Returns how many hypotheses are drawn at once, at most as many as were reserved.
  std::int64_t drawn_at_once() const { return draws() ? drawer_.at_once() : 1 << 20; }
  /// Returns the number of pixels of all views.
  std::int64_t pixels() const { return drawer_.pixels(); }
  /// Returns the number of terms with slopes.
  int sloped_terms() const { return sloped_terms_; }
  bool draws() const { return drawing_terms_ > 0; }
  /// Returns true if terms that need rendering have no slopes.
  bool draws_differences() const { return drawing_terms_ > sloped_terms_; }

  /// Returns true if every term has residuals on the GPU.
  bool has_residuals() const;
  /// Returns true if they also have slopes there: one at least, or none needs rendering.
  bool has_slopes() const { return has_residuals() && (sloped_terms_ > 0 || !draws()); }
  /// Returns the number of residuals per hypothesis of the prepared frame.
  std::int64_t residual_count() const;
  /// Returns the number of residuals of terms without slopes.
  std::int64_t difference_residual_count() const;
  /// See StateResiduals::pose_only().
  std::vector<ResidualRows> pose_only_residuals() const;

  /// Returns a number that grows whenever a term's revision() does.
  std::uint64_t revision() const;

 private:
  bool draws(std::size_t term) const;
  bool has_slopes(std::size_t term) const;
  void enqueue_beside(BatchLayout batch);
  template <class Enqueue>
  void add_up(BatchLayout& batch, const Enqueue& enqueue);
  template <class Enqueue>
  void draw_parts(const BatchLayout& batch, const Enqueue& enqueue);
  void clear_costs_without_terms(const BatchLayout& batch);

  Device device_;
  DeviceScene scene_;
  std::vector<ObjectiveTerm> terms_;
  std::vector<std::unique_ptr<DeviceObjective>> objectives_;  // of the terms
  std::vector<std::unique_ptr<SideStream>> sides_;            // likewise
  int drawing_terms_ = 0, sloped_terms_ = 0, weighted_terms_ = 0;
  bool draws_for_terms_ = false;  // because several need it, or one does not draw by itself
  TileUpload upload_;
  TileDrawer drawer_;
  DeviceObservation observation_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
