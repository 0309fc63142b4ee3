#pragma once

#include <cstdint>
#include <functional>

namespace hypotrack::cuda {

/// Calls `reserve` with a number of hypotheses. If it throws DeviceError for so many but not for
/// fewer (a half, a quarter, ...), adds to the message how many there is room for.
void reserve_batch(std::int64_t count, const std::function<void(std::int64_t)>& reserve);

}  // namespace hypotrack::cuda
