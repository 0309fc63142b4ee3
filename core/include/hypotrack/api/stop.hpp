#pragma once

#include <functional>

#include "hypotrack/api/export.hpp"

namespace hypotrack {

/// Returns true once a search has to end, also in the middle of a frame. It is called very often,
/// from several threads at once. It must be quick and must not throw.
using StopTest = std::function<bool()>;

/// Ends a search that a StopTest no longer wants. It is no std::exception, so that nothing takes it
/// for a failure: code that catches everything throws it again.
class HYPOTRACK_API Stopped {
 public:
  Stopped() = default;
  Stopped(const Stopped&) = default;
  Stopped& operator=(const Stopped&) = default;
  virtual ~Stopped();
};

/// Throws Stopped if the search that this thread works for has to end. Costs call it for every
/// hypothesis. A plugin that works for more than 0.1 s without any calls it, too.
HYPOTRACK_API void check_stop();

}  // namespace hypotrack
