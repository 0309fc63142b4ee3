#pragma once

#include "hypotrack/cuda/runtime.cuh"

namespace hypotrack::cuda {

/// Enqueues a copy of the first `count` objects.
template <class T>
void to_device(DeviceBuffer<T>& to, const PinnedBuffer<T>& from, std::size_t count, Stream stream) {
  check(cudaMemcpyAsync(to.data(), from.data(), count * sizeof(T), cudaMemcpyHostToDevice,
                        native(stream)),
        "uploading");
}

/// Enqueues a copy of `count` objects from number `first` on, to the same place.
template <class T>
void to_host(PinnedBuffer<T>& to, const DeviceBuffer<T>& from, std::size_t first, std::size_t count,
             Stream stream) {
  check(cudaMemcpyAsync(to.data() + first, from.data() + first, count * sizeof(T),
                        cudaMemcpyDeviceToHost, native(stream)),
        "downloading");
}

}  // namespace hypotrack::cuda
