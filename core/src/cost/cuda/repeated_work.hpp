#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/gpu/work_graph.cuh"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Enqueues work that comes again and again with the same arguments: as a graph after a while,
/// which takes one call of the driver for all kernels and copies.
class RepeatedWork {
 public:
  /// Tells two works apart: all that the arguments of their kernels and copies depend on.
  using Arguments = std::array<std::uint64_t, 4>;

  /// Enqueues the graph of a work. Returns false if there is none.
  bool launch(const Arguments& arguments, Stream stream) {
    const auto found = find(arguments);
    if (found == known_.end() || found->graph.empty()) return false;
    used(found).graph.launch(stream);
    return true;
  }

  /// Enqueues a work without a graph by `work()`. Captures it for a graph if it came before.
  template <class Work>
  void enqueue(const Arguments& arguments, Stream stream, const Work& work) {
    constexpr std::size_t kMost = 16;       // works
    constexpr int kBefore = 2, kTries = 2;  // times that it comes
    const auto found = find(arguments);
    if (found == known_.end()) {
      work();
      if (known_.size() == kMost) known_.erase(known_.begin());
      known_.push_back({arguments, 1, {}});
      return;
    }
    Known& known = used(found);
    const int before = known.times++;
    if (before < kBefore || before >= kBefore + kTries) return work();
    WorkGraph graph;
    try {
      graph.capture(stream, work);
    } catch (...) {  // another thread's call to the driver may have ended it; or it cannot be
      return work();
    }
    graph.launch(stream);
    known.graph = std::move(graph);
  }

 private:
  struct Known {
    Arguments arguments;
    int times;  ///< that it was enqueued without a graph
    WorkGraph graph;
  };
  /// Moves a work behind those that were used before it.
  Known& used(std::vector<Known>::iterator found) {
    std::rotate(found, std::next(found), known_.end());
    return known_.back();
  }
  std::vector<Known>::iterator find(const Arguments& arguments) {
    return std::ranges::find(known_, arguments, &Known::arguments);
  }

  std::vector<Known> known_;
};

}  // namespace internal
}  // namespace hypotrack::cuda
