#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <optional>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/gpu/work_graph.cuh"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Enqueues work that comes again and again with the same arguments: as a graph from its second
/// time on, which takes one call of the driver for all kernels and copies.
class RepeatedWork {
 public:
  /// Tells two works apart: all that the arguments of their kernels and copies depend on.
  using Arguments = std::array<std::uint64_t, 4>;

  /// Enqueues the graph of a work. Returns false if there is none yet.
  bool launch(const Arguments& arguments, Stream stream) {
    const auto found = find(arguments);
    if (found == known_.end() || !found->graph) return false;
    std::rotate(found, std::next(found), known_.end());  // the last one was used last
    known_.back().graph->launch(stream);
    return true;
  }

  /// Enqueues a work without a graph by `work()`. Captures it if it was enqueued before.
  template <class Work>
  void enqueue(const Arguments& arguments, Stream stream, const Work& work) {
    constexpr std::size_t kMost = 16;
    const auto found = find(arguments);
    if (found == known_.end()) {
      work();
      if (known_.size() == kMost) known_.erase(known_.begin());
      known_.push_back({arguments, std::nullopt});
      return;
    }
    WorkGraph graph;
    try {
      graph.capture(stream, work);
    } catch (const DeviceError&) {  // another thread's call to the driver may have ended it
      return work();
    }
    graph.launch(stream);
    found->graph = std::move(graph);
  }

 private:
  struct Known {
    Arguments arguments;
    std::optional<WorkGraph> graph;
  };
  std::vector<Known>::iterator find(const Arguments& arguments) {
    return std::ranges::find(known_, arguments, &Known::arguments);
  }

  std::vector<Known> known_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
