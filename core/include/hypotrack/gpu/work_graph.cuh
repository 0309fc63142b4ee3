#pragma once

#include <utility>

#include "hypotrack/gpu/runtime.cuh"

namespace hypotrack::cuda {

/// A CUDA graph: work that is captured from a stream once and launched many times.
class WorkGraph {
 public:
  WorkGraph() = default;
  ~WorkGraph() { reset(); }
  WorkGraph(WorkGraph&& other) noexcept : executable_(std::exchange(other.executable_, nullptr)) {}
  WorkGraph& operator=(WorkGraph&& other) noexcept {
    std::swap(executable_, other.executable_);
    return *this;
  }

  /// Captures the work that `enqueue()` enqueues on the stream, without running it. Passes
  /// exceptions of `enqueue` on; the stream is then usable and the graph empty.
  template <class Enqueue>
  void capture(Stream stream, const Enqueue& enqueue) {
    reset();
    Captured captured;
    check(cudaStreamBeginCapture(native(stream), cudaStreamCaptureModeThreadLocal),
          "beginning to capture work");
    try {
      enqueue();
    } catch (...) {
      (void)cudaStreamEndCapture(native(stream), &captured.graph);
      (void)cudaGetLastError();  // of an interrupted capture
      throw;
    }
    check(cudaStreamEndCapture(native(stream), &captured.graph), "capturing work");
    check(cudaGraphInstantiate(&executable_, captured.graph, 0), "making a graph of captured work");
  }
  /// Returns true if nothing is captured.
  bool empty() const { return executable_ == nullptr; }
  /// Enqueues the captured work. Precondition: !empty().
  void launch(Stream stream) const {
    check(cudaGraphLaunch(executable_, native(stream)), "launching captured work");
  }
  /// Deletes the captured work.
  void reset() {
    if (executable_) cudaGraphExecDestroy(std::exchange(executable_, nullptr));
  }

 private:
  /// Owns a graph that is not executable yet.
  struct Captured {
    cudaGraph_t graph = nullptr;
    ~Captured() {
      if (graph) cudaGraphDestroy(graph);
    }
  };

  cudaGraphExec_t executable_ = nullptr;
};

}  // namespace hypotrack::cuda
