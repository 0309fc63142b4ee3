#include "lab/report/trace/profiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/statistics.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

double expected_running_time(std::span<const Trial> trials) {
  double spent = 0, reached = 0;
  for (const Trial& trial : trials) {
    spent += trial.spent;
    reached += trial.reached;
  }
  return reached == 0 ? kNever : spent / reached;
}

std::vector<double> performance_ratios(std::span<const Trial> of_solvers) {
  double least = kNever;
  for (const Trial& trial : of_solvers)
    if (trial.reached) least = std::min(least, trial.spent);
  std::vector<double> ratios;
  for (const Trial& trial : of_solvers)
    ratios.push_back(trial.reached ? trial.spent / least : kNever);
  return ratios;
}

double simplex_gradients(const Trial& trial, int dimension) {
  return trial.reached ? trial.spent / (dimension + 1) : kNever;
}

double share_within(std::span<const double> numbers, double limit) {
  const auto count = std::ranges::count_if(numbers, [&](double n) { return n <= limit; });
  return static_cast<double>(count) / static_cast<double>(numbers.size());
}

std::optional<Quartiles> quartiles(std::vector<double> numbers) {
  if (numbers.empty()) return std::nullopt;
  return Quartiles{percentile(numbers, 0.25), percentile(numbers, 0.5), percentile(numbers, 0.75)};
}

std::vector<double> geometric_places(double lowest, double highest, int count) {
  std::vector<double> places{lowest};
  if (!(highest > lowest)) return places;
  for (int i = 1; i < count - 1; ++i)
    places.push_back(lowest * std::pow(highest / lowest, i / (count - 1.0)));
  places.push_back(highest);
  return places;
}

}  // namespace hypotrack::internal
