#pragma once

#include <cstdint>
#include <vector>

#include "hypotrack/gpu/runtime.cuh"
#include "hypotrack/plugin/observation.hpp"

namespace hypotrack::test {

enum class Texture { noise, waves, flat };

/// What a made-up view looks like.
struct ViewOptions {
  int width = 128, height = 128;
  Texture texture = Texture::waves;
  bool mask = false;
  int valid_pixels = -1;  ///< so many at random places; -1: all but a few
  std::uint32_t seed = 1;
};

/// A tile with colour and, if wanted, mask.
TileView made_up_view(const ViewOptions& options);

/// An observation in device memory: pixels and, where a view has it, depth (without gaps).
class DeviceFrame {
 public:
  /// Waits until they are there.
  DeviceFrame(const Observation& observation, cuda::Stream stream);
  const cuda::DeviceObservation& observation() const { return observation_; }

 private:
  cuda::DeviceObservation observation_;
  cuda::DeviceBuffer<std::uint32_t> pixels_[cuda::kMaxViews];
  cuda::DeviceBuffer<float> depth_[cuda::kMaxViews];
};

/// The first `count` objects of device memory, after all that is enqueued.
template <class T>
std::vector<T> download(const T* from, std::size_t count, cuda::Stream stream) {
  std::vector<T> out(count);
  cuda::check(cudaMemcpyAsync(out.data(), from, count * sizeof(T), cudaMemcpyDeviceToHost,
                              cuda::native(stream)),
              "downloading");
  cuda::check(cudaStreamSynchronize(cuda::native(stream)), "downloading");
  return out;
}

}  // namespace hypotrack::test
