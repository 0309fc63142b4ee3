#pragma once

#include "base/exported.hpp"
#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// A second stream, whose work runs beside that of a main stream.
class SideStream {
 public:
  SideStream();
  ~SideStream();
  SideStream(const SideStream&) = delete;
  SideStream& operator=(const SideStream&) = delete;

  Stream stream() const { return {stream_}; }
  /// Makes what is enqueued here from now on wait for what `main` has so far.
  void fork(Stream main);
  /// Makes what is enqueued on `main` from now on wait for what this stream has so far.
  void join(Stream main);
  /// Waits until all work of this stream is done, or ended by an error.
  void end() const;

 private:
  cudaStream_t stream_ = nullptr;
  cudaEvent_t forked_ = nullptr, joined_ = nullptr;
};

}  // namespace internal
}  // namespace hypotrack::cuda
