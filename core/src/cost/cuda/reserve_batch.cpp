#include "cost/cuda/reserve_batch.hpp"

#include <fmt/format.h>

#include "hypotrack/api/error.hpp"

namespace hypotrack::cuda::internal {
namespace {

/// Returns the largest of count / 2, count / 4, ... 1 that can be reserved; 0 if none can.
std::int64_t what_fits(std::int64_t count, const std::function<void(std::int64_t)>& reserve) {
  for (count /= 2; count > 0; count /= 2) {
    try {
      reserve(count);
      return count;
    } catch (const DeviceError&) {
    }
  }
  return 0;
}

}  // namespace

void reserve_batch(std::int64_t count, const std::function<void(std::int64_t)>& reserve) {
  try {
    reserve(count);
  } catch (const DeviceError& error) {
    const std::int64_t fits = what_fits(count, reserve);
    if (fits == 0) throw;
    throw DeviceError(
        fmt::format("{}: there is room for {} hypotheses at a time, {} were asked for",
                    error.what(), fits, count));
  }
}

}  // namespace hypotrack::cuda::internal
