#include "cuda/feature_maps.hpp"

#include <cstddef>
#include <vector>

#include "color-inl.hpp"

namespace hypotrack::stereo_color {
namespace {

// Returns whether kernels can start early on the current device.
bool can_overlap() {
  int device = 0, major = 0;
  cuda::check(cudaGetDevice(&device), "asking for the device");
  cuda::check(cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, device),
              "asking for the device's compute capability");
  return cuda::overlaps_launches({.compute_capability = 10 * major});
}

}  // namespace

void FeatureMaps::make_shared_buffers(cuda::Stream stream) {
  if (medians_.data()) return;
  overlap_ = can_overlap();
  counts_.reserve(2 * kQuantities * kBuckets);
  cuda::check(cudaMemsetAsync(counts_.data(), 0, counts_.size() * sizeof(std::uint32_t),
                              cuda::native(stream)),
              "clearing memory");
  if (settings_.color_space == ColorSpace::lab) {
    const std::vector<LabNode> nodes = lab_nodes();
    lab_nodes_.reserve(nodes.size());
    cuda::check(cudaMemcpyAsync(lab_nodes_.data(), nodes.data(), nodes.size() * sizeof(LabNode),
                                cudaMemcpyHostToDevice, cuda::native(stream)),
                "uploading a table");
  }
  medians_.reserve(2 * kQuantities);
}

ViewJob FeatureMaps::view_job(const cuda::DeviceTile& tile, int view) {
  View& v = views_[view];
  const auto pixels =
      static_cast<std::size_t>(tile.layout.width) * static_cast<std::size_t>(tile.layout.height);
  const std::size_t plane = (pixels + 3) / 4 * 4;  // keeps the second plane aligned
  v.keys.reserve(kQuantities * plane);
  v.features.reserve(pixels);
  ViewJob job{};
  job.tile = tile.layout;
  for (int q = 0; q < kQuantities; ++q) job.keys[q] = v.keys.data() + q * plane;
  job.counts = counts_.data() + view * kQuantities * kBuckets;
  job.medians = medians_.data() + view * kQuantities;
  job.features = v.features.data();
  job.masked = settings_.use_mask && tile.has_mask;
  return job;
}

void FeatureMaps::enqueue(const cuda::DeviceObservation& observation, cuda::Stream stream) {
  make_shared_buffers(stream);
  FeatureJob job{};
  for (int i = 0; i < 2; ++i) {
    job.views[i] = view_job(observation.tiles[static_cast<std::size_t>(i)], i);
  }
  job.color_space = settings_.color_space;
  job.gray_weight = static_cast<float>(settings_.gray_weight);
  job.weighted = settings_.distinctiveness == Distinctiveness::principal_curvatures;
  job.w_t = static_cast<float>(settings_.w_t);
  job.lab_nodes = lab_nodes_.data();
  if (job.weighted) {
    enqueue_textures(job, stream, overlap_);
    enqueue_medians(job, stream, overlap_);
  }
  enqueue_features(job, stream, overlap_);
}

}  // namespace hypotrack::stereo_color
