#pragma once

#include <optional>
#include <vector>

#include "base/exported.hpp"
#include "lab/bench/bench_table.hpp"

namespace hypotrack::bench {
inline namespace HYPOTRACK_EXPORTED internal {

/// Timing statistics of a row. Times are in seconds.
struct Numbers {
  double median = 0, p5 = 0, p95 = 0;
  double fps = 0;                     ///< 1 / median
  double evaluations = 0;             ///< of the median frame
  double evaluations_per_second = 0;  ///< median over the frames
};

/// Returns the statistics of a measurement; nothing if it has no frames.
std::optional<Numbers> numbers_of(const Measurement& measurement);

/// Returns how many times as fast a row is as another configuration in the same round and case.
/// Nothing if either was not measured.
std::optional<double> speed_over(const Row& row, std::size_t configuration,
                                 const std::vector<Row>& rows);

}  // namespace internal
}  // namespace hypotrack::bench
