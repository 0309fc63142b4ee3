#pragma once

#include "cuda/feature_job.hpp"
#include "hypotrack/cuda/runtime.cuh"
#include "settings.hpp"

namespace hypotrack::stereo_color {

/// The features of both views of a frame in device memory: the numbers of make_features(), one
/// 8-byte word per pixel.
class FeatureMaps {
 public:
  explicit FeatureMaps(const Settings& settings) : settings_(settings) {}

  /// Enqueues what makes them of the first two tiles, which have been checked (checks.hpp).
  void enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream);

  /// Device memory: of view 0 or 1, row by row without gaps. The same until a larger tile comes.
  const PackedFeatures* of_view(int view) const { return views_[view].features.data(); }
  /// Device memory: the middle norms and the middle ratios of view 0, then those of view 1.
  const Middle* middles() const { return middles_.data(); }

 private:
  struct View {
    cuda::DeviceBuffer<Key> keys;
    cuda::DeviceBuffer<PackedFeatures> features;
  };
  void make_shared_buffers(cuda::Stream stream);
  ViewJob view_job(const cuda::DeviceTile& tile, int view);

  Settings settings_;
  View views_[2];
  cuda::DeviceBuffer<std::uint32_t> counts_;
  cuda::DeviceBuffer<Middle> middles_;
  cuda::DeviceBuffer<LabNode> lab_nodes_;
  bool overlap_ = false;
};

}  // namespace hypotrack::stereo_color
