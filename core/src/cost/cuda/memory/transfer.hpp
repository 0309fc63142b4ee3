#pragma once

#include "base/exported.hpp"
#include "base/profile.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Waits until a stream has finished. Throws DeviceError, which names the work.
inline void wait_for(Stream stream, const char* work) {
  const ProfiledPart part("wait for the GPU");
  check(cudaStreamSynchronize(native(stream)), work);
}

/// Enqueues the upload of the first `count` objects.
template <class T>
void to_device(DeviceBuffer<T>& to, const PinnedBuffer<T>& from, std::size_t count, Stream stream) {
  check(cudaMemcpyAsync(to.data(), from.data(), count * sizeof(T), cudaMemcpyHostToDevice,
                        native(stream)),
        "uploading");
}

/// Enqueues the download of `count` objects, starting at number `first`, to the same indices.
template <class T>
void to_host(PinnedBuffer<T>& to, const DeviceBuffer<T>& from, std::size_t first, std::size_t count,
             Stream stream) {
  check(cudaMemcpyAsync(to.data() + first, from.data() + first, count * sizeof(T),
                        cudaMemcpyDeviceToHost, native(stream)),
        "downloading");
}

}  // namespace internal
}  // namespace hypotrack::cuda
