#pragma once

#include <functional>

#include "hypotrack/cuda/runtime.cuh"

namespace hypotrack::cuda {

/// Work that was captured from a stream once and can be launched again and again.
class SearchGraph {
 public:
  SearchGraph() = default;
  ~SearchGraph();
  SearchGraph(const SearchGraph&) = delete;
  SearchGraph& operator=(const SearchGraph&) = delete;

  /// Captures what `enqueue` enqueues on the stream, without running it. What `enqueue` throws
  /// passes through; the stream is then usable and the graph empty.
  void capture(Stream stream, const std::function<void()>& enqueue);
  /// Enqueues all of it.
  void launch(Stream stream) const;
  /// Forgets it.
  void reset();

 private:
  cudaGraphExec_t executable_ = nullptr;
};

}  // namespace hypotrack::cuda
