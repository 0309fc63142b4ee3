#pragma once

#include <cstddef>
#include <oneapi/dnnl/dnnl.hpp>
#include <utility>
#include <vector>

#include "network_file.hpp"

namespace hypotrack::hands {

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
