#pragma once

#include <cstdint>
#include <functional>

#include "base/exported.hpp"

namespace hypotrack::cuda {
inline namespace HYPOTRACK_EXPORTED internal {

/// Calls `reserve` with a number of hypotheses. If that throws DeviceError but a half, a quarter,
/// ... succeeds, adds to the message how many hypotheses fit.
void reserve_batch(std::int64_t count, const std::function<void(std::int64_t)>& reserve);

}  // namespace internal
}  // namespace hypotrack::cuda
