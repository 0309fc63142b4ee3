#include "search_graph.hpp"

#include <utility>

namespace hypotrack::cuda {
namespace {

/// Owns a graph that is not executable yet.
struct Graph {
  cudaGraph_t graph = nullptr;
  ~Graph() {
    if (graph) cudaGraphDestroy(graph);
  }
};

}  // namespace

SearchGraph::~SearchGraph() { reset(); }

void SearchGraph::reset() {
  if (executable_) cudaGraphExecDestroy(std::exchange(executable_, nullptr));
}

void SearchGraph::capture(Stream stream, const std::function<void()>& enqueue) {
  reset();
  Graph captured;
  check(cudaStreamBeginCapture(native(stream), cudaStreamCaptureModeThreadLocal),
        "beginning to capture a search");
  try {
    enqueue();
  } catch (...) {
    (void)cudaStreamEndCapture(native(stream), &captured.graph);
    (void)cudaGetLastError();  // of an interrupted capture
    throw;
  }
  check(cudaStreamEndCapture(native(stream), &captured.graph), "capturing a search");
  check(cudaGraphInstantiate(&executable_, captured.graph, 0), "making a graph of a search");
}

void SearchGraph::launch(Stream stream) const {
  check(cudaGraphLaunch(executable_, native(stream)), "launching a search");
}

}  // namespace hypotrack::cuda
