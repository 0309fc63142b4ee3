#include "lab/bench/bench_numbers.hpp"

#include "base/statistics.hpp"

namespace hypotrack::bench::internal {

std::optional<Numbers> numbers_of(const Measurement& measurement) {
  const auto& seconds = measurement.seconds;
  if (measurement.outcome != Outcome::measured || seconds.empty()) return std::nullopt;
  std::vector<double> rates;
  for (std::size_t i = 0; i < seconds.size(); ++i)
    rates.push_back(measurement.evaluations[i] / seconds[i]);
  Numbers numbers;
  numbers.median = percentile(seconds, 0.5);
  numbers.p5 = percentile(seconds, 0.05);
  numbers.p95 = percentile(seconds, 0.95);
  numbers.fps = 1 / numbers.median;
  numbers.evaluations = percentile(measurement.evaluations, 0.5);
  numbers.evaluations_per_second = percentile(rates, 0.5);
  return numbers;
}

std::optional<double> speed_over(const Row& row, std::size_t configuration,
                                 const std::vector<Row>& rows) {
  const auto own = numbers_of(row.measurement);
  for (const Row& other : rows) {
    if (other.round != row.round || other.case_index != row.case_index ||
        other.configuration != configuration)
      continue;
    const auto numbers = numbers_of(other.measurement);
    if (own && numbers) return numbers->median / own->median;
  }
  return std::nullopt;
}

}  // namespace hypotrack::bench::internal
