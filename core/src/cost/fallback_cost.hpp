#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Owns the cost of a scene, and replaces it by one on the CPU after its device failed.
class FallbackCost {
 public:
  /// As make_cost(). Throws ConfigError if the settings ask for the CPU after a loss, but what is
  /// required needs a device.
  FallbackCost(const Scene& scene, std::vector<ObjectiveTerm> terms,
               const EvaluateSettings& settings, const Requirements& requirements);

  Cost& operator*() const { return *cost_; }
  Cost* operator->() const { return cost_.get(); }

  /// Evaluates on the CPU from now on; a frame has to be prepared anew. Call it while handling
  /// `error`, which it throws again if the settings do not ask for that or the cost is on the CPU.
  void leave_device(const DeviceError& error);

  /// Returns why the device was left; empty: it was not.
  const std::string& device_error() const { return device_error_; }

 private:
  const Scene& scene_;
  std::vector<ObjectiveTerm> terms_;
  EvaluateSettings settings_;
  Requirements requirements_;
  std::unique_ptr<Cost> cost_;
  std::string device_error_;
};

}  // namespace internal
}  // namespace hypotrack
