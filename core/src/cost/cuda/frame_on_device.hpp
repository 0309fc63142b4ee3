#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "cost/cuda/device.hpp"
#include "cost/cuda/device_scene.hpp"
#include "cost/cuda/tile_upload.hpp"
#include "cost/evaluator.hpp"
#include "hypotrack/cuda/runtime.cuh"

namespace hypotrack::cuda {

/// A frame on the GPU and the terms that score hypotheses of it, all on one stream.
class FrameOnDevice {
 public:
  /// All terms have a device part. Throws DeviceError if the GPU or the scene cannot be used.
  FrameOnDevice(const Scene& scene, const std::vector<ObjectiveTerm>& terms,
                const EvaluateSettings& settings);
  ~FrameOnDevice();
  FrameOnDevice(const FrameOnDevice&) = delete;
  FrameOnDevice& operator=(const FrameOnDevice&) = delete;

  const Device& device() const { return device_; }
  Stream stream() const { return device_.stream(); }
  const std::vector<ObjectiveTerm>& terms() const { return terms_; }

  /// Makes the GPU the calling thread's and waits for the frame before: its uploads may still read
  /// staging memory if it was never searched, or if an error ended that.
  void finish();

  /// Takes a frame in whose tiles the CPU cut; finish() comes first.
  void prepare(const Observation& observation);
  /// The same for tiles that are on the GPU already.
  void prepare(const DeviceObservation& observation);

  /// Makes room for batches of `count` hypotheses. Throws DeviceError, saying how many there is
  /// room for, if there is too little memory.
  void reserve(std::int64_t count);
  /// The same with `more`, which reserves what else such a batch takes.
  void reserve(std::int64_t count, const std::function<void(std::int64_t)>& more);

  /// Enqueues all terms for a batch; `batch.weight` and `batch.add` are set here.
  void enqueue(BatchLayout batch);
  /// DeviceCost::enqueue_search(), which a single term can do; `batch.weight` is set here.
  bool enqueue_search(BatchLayout batch, const SwarmSearch& search);
  /// The same with the residuals of all terms, one after the other, each times the root of its
  /// weight: residual_count() of every hypothesis. The terms are a sum of squares (TermResiduals).
  void enqueue(BatchLayout batch, float* residuals);
  /// The same for hypotheses that are drawn already.
  void enqueue_drawn(BatchLayout batch, const DrawnBatch& drawn);

  /// Whether every term has residuals on the GPU.
  bool has_residuals() const;
  /// Of every hypothesis of the prepared frame.
  std::int64_t residual_count() const;
  /// Evaluator::pose_only_residuals().
  std::vector<ResidualRows> pose_only_residuals() const;

  /// Grows whenever a term's does.
  std::uint64_t revision() const;

 private:
  template <class Enqueue>
  void add_up(BatchLayout& batch, const Enqueue& enqueue);
  void clear_costs_without_terms(const BatchLayout& batch);

  Device device_;
  DeviceScene scene_;
  std::vector<ObjectiveTerm> terms_;
  std::vector<std::unique_ptr<DeviceObjective>> objectives_;  // of the terms
  TileUpload upload_;
  DeviceObservation observation_;
};

}  // namespace hypotrack::cuda
