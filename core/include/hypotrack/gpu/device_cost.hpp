#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "hypotrack/api/export.hpp"
#include "hypotrack/gpu/damped_steps.hpp"
#include "hypotrack/gpu/device_objective.hpp"

namespace hypotrack::cuda {

/// A search by damped least squares and its answer, in memory of the host. Arrays have a number per
/// dimension of the search.
struct Descent {
  const double* start;
  const double* lower;
  const double* upper;
  const double* spread;
  double* point;                 ///< the best point evaluated
  double cost = 0;               ///< of that point
  std::int64_t evaluations = 0;  ///< that were made
};

/// A cost function with points and costs in device memory, from CostFunction::device().
class HYPOTRACK_API DeviceCost {
 public:
  virtual ~DeviceCost();

  /// Returns the stream of all work. The frame's features are already enqueued on it.
  virtual Stream stream() const = 0;

  /// Allocates memory for batches of up to `count` points. Call it before enqueue(), not during a
  /// capture. Throws DeviceError if there is not enough memory.
  virtual void reserve(std::int64_t count) = 0;

  /// Enqueues the evaluation of `count` points. `points` (dimension doubles each, consecutive) and
  /// `costs` (count doubles) are in device memory. It only launches kernels, so that a CUDA graph
  /// can capture a whole search. They call let_next_start() only after their own wait.
  virtual void enqueue(const double* points, std::int64_t count, double* costs) = 0;

  /// Enqueues a whole search as one kernel, if possible; reserve() must precede it with the number
  /// of particles. Returns false if it enqueued nothing.
  virtual bool enqueue_search(const SwarmSearch& search);

  /// Returns a number that stays the same, over frames, as long as a graph captured from enqueue()
  /// remains valid.
  virtual std::uint64_t revision() const = 0;
};

/// A DeviceCost may also derive from this: searches by damped least squares whose steps stay on the
/// GPU.
class HYPOTRACK_API DescentCost {
 public:
  virtual ~DescentCost();

  /// Searches by DampedSteps, all in step, from points of `dimension` numbers. Returns false, and
  /// did nothing, where the terms or the sizes do not allow it. Asks `ends()` now and then; true
  /// ends all searches. Throws Error as CostFunction::evaluate().
  virtual bool descend(const DampedSettings& settings, std::int32_t dimension,
                       std::span<Descent> searches, const std::function<bool()>& ends) = 0;
};

}  // namespace hypotrack::cuda
