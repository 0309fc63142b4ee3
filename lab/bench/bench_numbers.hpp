#pragma once

#include <optional>
#include <vector>

#include "lab/bench/bench_table.hpp"

namespace hypotrack::bench {

/// The numbers of a row that has frames. Times are in seconds.
struct Numbers {
  double median = 0, p5 = 0, p95 = 0;
  double fps = 0;                     ///< 1 / median
  double evaluations = 0;             ///< of the median frame
  double evaluations_per_second = 0;  ///< median over the frames
};

HYPOTRACK_API std::optional<Numbers> numbers_of(const Measurement& measurement);

/// How many times as fast a row is as another way in the same round and case; nothing if either was
/// not measured.
HYPOTRACK_API std::optional<double> speed_over(const Row& row, std::size_t way,
                                               const std::vector<Row>& rows);

}  // namespace hypotrack::bench
