#pragma once

#include <omp.h>

#include <cstddef>
#include <oneapi/dnnl/dnnl.hpp>
#include <utility>
#include <vector>

#include "network_file.hpp"

namespace hypotrack::hands {

/// Gives oneDNN, whose threads are those of OpenMP, a number of threads, the
/// calling one included.
class OmpThreads {
 public:
  explicit OmpThreads(int threads) : before_(omp_get_max_threads()), several_(threads > 1) {
    omp_set_num_threads(threads);
  }
  ~OmpThreads() {
    // They would keep cores busy while they wait for more work of this thread.
    if (several_) omp_pause_resource(omp_pause_soft, omp_get_initial_device());
    omp_set_num_threads(before_);
  }
  OmpThreads(const OmpThreads&) = delete;
  OmpThreads& operator=(const OmpThreads&) = delete;

 private:
  int before_;
  bool several_;
};

/// Memory that operations of a plan read and write.
struct PlanBuffer {
  dnnl::memory::desc desc{};
  dnnl::memory constant{};  ///< weights; empty: the buffer lies in a context's memory
  int first = 0, last = 0;  ///< the operations between which it is in use
  std::size_t offset = 0;   ///< bytes
};

/// A primitive of oneDNN and its arguments: their kinds and buffers.
struct PlanOperation {
  dnnl::primitive primitive;
  std::vector<std::pair<int, std::size_t>> arguments;
};

/// A network as primitives of oneDNN in the order of computation. All tensors are ordered [y, x,
/// channel]; buffers share their memory with others that are not in use at the same time.
struct NetworkPlan {
  dnnl::engine engine{dnnl::engine::kind::cpu, 0};
  std::vector<PlanBuffer> buffers;  ///< the first one is the picture
  std::vector<PlanOperation> operations;
  std::vector<std::vector<std::size_t>> outputs;  ///< buffers of each output of the graph
  std::size_t size = 0;                           ///< bytes of all buffers that are not constant
};

/// Plans a network for a number of threads. Throws dnnl::error if oneDNN cannot compute it.
NetworkPlan plan_network(const NetworkGraph& graph, int threads);

}  // namespace hypotrack::hands
