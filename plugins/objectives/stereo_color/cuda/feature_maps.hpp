#pragma once

#include "cuda/feature_job.hpp"
#include "hypotrack/gpu/runtime.cuh"
#include "settings.hpp"

namespace hypotrack::stereo_color {

/// The features of both views of a frame in device memory: the results of make_features(), one
/// 8-byte word per pixel.
class FeatureMaps {
 public:
  explicit FeatureMaps(const Settings& settings) : settings_(settings) {}

  /// Enqueues the computation for the first two tiles, which must have passed check().
  void enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream);

  /// Returns device memory: the features of view 0 or 1, row by row without gaps. The address
  /// changes only when a larger tile comes.
  const PackedFeatures* of_view(int view) const { return views_[view].features.data(); }
  /// Returns device memory: the median norms and ratios of view 0, then those of view 1.
  const MedianPair* medians() const { return medians_.data(); }

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
  cuda::DeviceBuffer<MedianPair> medians_;
  cuda::DeviceBuffer<LabNode> lab_nodes_;
  bool overlap_ = false;
};

}  // namespace hypotrack::stereo_color
