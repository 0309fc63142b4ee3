#pragma once

#include <functional>

#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {

/// A CUDA graph that is captured from a stream once and launched many times.
class SearchGraph {
 public:
  SearchGraph() = default;
  ~SearchGraph();
  SearchGraph(const SearchGraph&) = delete;
  SearchGraph& operator=(const SearchGraph&) = delete;

  /// Captures the work that `enqueue` enqueues on the stream, without running it. Passes exceptions
  /// of `enqueue` on; the stream is then usable and the graph empty.
  void capture(Stream stream, const std::function<void()>& enqueue);
  /// Enqueues the captured work.
  void launch(Stream stream) const;
  /// Deletes the captured work.
  void reset();

 private:
  cudaGraphExec_t executable_ = nullptr;
};

}  // namespace hypotrack::cuda
