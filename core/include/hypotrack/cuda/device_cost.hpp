#pragma once

#include <cstdint>

#include "hypotrack/cuda/device_objective.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack::cuda {

/// A cost function whose points and costs stay on the device; CostFunction::device() gives it.
class HYPOTRACK_API DeviceCost {
 public:
  virtual ~DeviceCost();

  /// Where everything is enqueued. The frame's features are already on their way there.
  virtual Stream stream() const = 0;

  /// Makes room for batches of up to `count` points; before enqueue(), and not while capturing.
  /// Throws DeviceError if the memory is not to be had.
  virtual void reserve(std::int64_t count) = 0;

  /// Enqueues the costs (count doubles) of points (dimension x count doubles, one after the other),
  /// both in device memory. Only launches kernels: a whole search can be captured into a graph.
  /// They let the next kernel start early only after their own wait (let_next_start()).
  virtual void enqueue(const double* points, std::int64_t count, double* costs) = 0;

  /// Enqueues a whole search in one kernel where that can be done, after reserve() for its
  /// particles. False: nothing was enqueued.
  virtual bool enqueue_search(const SwarmSearch& search);

  /// A graph captured from enqueue() may be launched again as long as this number stays the same,
  /// frame after frame.
  virtual std::uint64_t revision() const = 0;
};

}  // namespace hypotrack::cuda
