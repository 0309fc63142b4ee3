#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <sstream>

#include "cost/cuda/device.hpp"
#include "device_twin.hpp"
#include "random_search.hpp"
#include "search_problems.hpp"
#include "subject.hpp"

namespace hypotrack::contract {
namespace {

using test::RecordingCost;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One search and everything that it evaluated.
struct Run {
  SearchRegion region;
  Budget budget;
  RecordingCost cost;
  OptimizerResult result;

  std::string what() const {
    return "in " + std::to_string(cost.dimension()) + " dimensions with a budget of " +
           std::to_string(budget.evaluations);
  }
};

/// Searches; evaluates the same costs on the device if the optimizer needs one.
OptimizerResult minimize(const Subject& subject, Optimizer& optimizer, RecordingCost& cost,
                         const SearchRegion& region, const Budget& budget, std::uint64_t seed) {
  if (!subject.claims("needs_device")) return optimizer.minimize(cost, region, budget, seed);
  test::DeviceTwin twin(cost);
  return optimizer.minimize(twin, region, budget, seed);
}

Run search(const Subject& subject, const SearchRegion& region, RecordingCost::Function function,
           const Budget& budget, std::uint64_t seed = 1) {
  Run run{region,
          budget,
          RecordingCost(static_cast<int>(region.start.size()), std::move(function)),
          {}};
  run.result = minimize(subject, *subject.make<Optimizer>(), run.cost, run.region, budget, seed);
  return run;
}

void check_start(const Run& run) {
  require(!run.cost.points.empty() && run.cost.points[0] == run.region.start,
          run.what() + ": the first point evaluated is not the region's start");
}

void check_budget(const Run& run) {
  require(static_cast<std::int64_t>(run.cost.points.size()) <= run.budget.evaluations,
          run.what() + ": evaluated " + std::to_string(run.cost.points.size()) + " points");
}

void check_count(const Run& run) {
  require(static_cast<std::int64_t>(run.cost.points.size()) == run.result.evaluations,
          run.what() + ": reported " + std::to_string(run.result.evaluations) +
              " evaluations, made " + std::to_string(run.cost.points.size()));
}

void check_bounds(const Run& run) {
  for (const Eigen::VectorXd& point : run.cost.points) {
    for (Eigen::Index d = 0; d < point.size(); ++d) {
      // Also false for a NaN.
      const bool inside = point[d] >= run.region.lower[d] && point[d] <= run.region.upper[d];
      std::ostringstream text;
      text << run.what() << ": evaluated " << point[d] << " in dimension " << d
           << ", expected within [" << run.region.lower[d] << ", " << run.region.upper[d] << "]";
      require(inside, text.str());
    }
  }
}

void check_best(const Run& run) {
  require(!run.cost.costs.empty(), run.what() + ": evaluated nothing");
  const double best = *std::ranges::min_element(run.cost.costs);
  require(run.result.cost == best, run.what() + ": returned cost " +
                                       std::to_string(run.result.cost) + ", the best was " +
                                       std::to_string(best));
  for (std::size_t i = 0; i < run.cost.points.size(); ++i) {
    if (run.cost.costs[i] == best && run.cost.points[i] == run.result.point) return;
  }
  throw Violation(run.what() + ": the returned point is not the one of the best cost");
}

void check_all(const Run& run) {
  for (const auto& check : {check_start, check_budget, check_count, check_bounds, check_best}) {
    check(run);
  }
}

/// Runs searches of all sizes, from a rigid object's to two hands', with budgets down to one
/// evaluation.
std::vector<Run> searches_of_all_sizes(const Subject& subject) {
  std::vector<Run> runs;
  for (const int dimension : {1, 7, 27, 54}) {
    const SearchRegion region = test::tracking_region(dimension);
    for (const std::int64_t evaluations : {1, 2, 7, 1024}) {
      runs.push_back(search(
          subject, region, test::ellipsoid(region, test::hidden_target(region, 5)), {evaluations}));
    }
  }
  return runs;
}

void check_repeatable(const Subject& subject) {
  const SearchRegion region = test::tracking_region(27);
  const auto problem = test::rosenbrock(region, test::hidden_target(region, 5));
  const auto same = [](const RecordingCost& a, const RecordingCost& b) {
    return a.points == b.points;
  };
  const auto optimizer = subject.make<Optimizer>();
  RecordingCost first(27, problem), other(27, problem), second(27, problem);
  minimize(subject, *optimizer, first, region, {500}, 77);
  minimize(subject, *optimizer, other, region, {300}, 78);
  minimize(subject, *optimizer, second, region, {500}, 77);
  require(same(first, second), "one object, searching twice with one seed, took two ways");
  require(same(first, search(subject, region, problem, {500}, 77).cost),
          "two objects took two ways with one seed");
}

void check_infeasible(const Subject& subject) {
  const SearchRegion region = test::tracking_region(10);
  const auto smooth = test::sphere(region, test::hidden_target(region, 5));
  const Run beside = search(subject, region,
                            [&](const Eigen::VectorXd& x) {
                              const double limit = region.start[1] + 0.3 * region.spread[1];
                              return x[1] > limit ? kInfinity : smooth(x);
                            },
                            {1024});
  check_all(beside);
  require(std::isfinite(beside.result.cost), "found nothing feasible from a feasible start");
  check_all(search(subject, region, [](const Eigen::VectorXd&) { return kInfinity; }, {200}));
}

struct Special : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Checks that exceptions of enqueuing pass through, and that the search after them works.
void check_exceptions_of_device(const Subject& subject) {
  const SearchRegion region = test::tracking_region(27);
  const auto smooth = test::sphere(region, test::hidden_target(region, 5));
  const auto optimizer = subject.make<Optimizer>();
  for (const int when : {0, 2}) {
    Run run{region, {500}, RecordingCost(27, smooth), {}};
    test::DeviceTwin twin(run.cost);
    int calls = 0;
    twin.on_enqueue([&] {
      if (calls++ == when) throw Special("a particular problem");
    });
    try {
      optimizer->minimize(twin, region, run.budget, 1);
      require(false, "an exception of the cost disappeared");
    } catch (const Special& special) {
      require(special.what() == std::string("a particular problem"), "its message changed");
      require(calls == when + 1, "evaluation went on after the exception");
    }
    run.cost = RecordingCost(27, smooth);
    run.result = optimizer->minimize(twin, region, run.budget, 1);
    check_all(run);
  }
}

void check_exceptions(const Subject& subject) {
  if (subject.claims("needs_device")) return check_exceptions_of_device(subject);
  const SearchRegion region = test::tracking_region(27);
  const auto smooth = test::sphere(region, test::hidden_target(region, 5));
  for (const int when : {0, 20}) {
    int calls = 0;
    try {
      search(subject, region,
             [&](const Eigen::VectorXd& x) {
               if (calls++ >= when) throw Special("a particular problem");
               return smooth(x);
             },
             {500});
    } catch (const Special& special) {
      require(special.what() == std::string("a particular problem"), "its message changed");
      require(calls == when + 1, "evaluation went on after the exception");
      continue;
    }
    require(calls <= when, "an exception of the cost disappeared");
  }
}

void check_time(const Subject& subject) {
  const SearchRegion region = test::tracking_region(27);
  constexpr std::int64_t kMany = 200000;
  const Run run = search(subject, region, test::rosenbrock(region, region.start), {kMany, 0.0});
  require(run.result.evaluations < kMany, "a budget of 0 seconds did not end the search");
  check_start(run);
}

void check_against_random_search(const Subject& subject) {
  if (subject.name == "random_search") throw Skipped("it is the baseline itself");
  constexpr int kSeeds = 3;
  const std::int64_t budget =
      std::min<std::int64_t>(subject.make<Optimizer>()->default_evaluations(), 2048);
  const SearchRegion region = test::tracking_region(27);
  double mean = 0;
  double baseline = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const auto problem = test::sphere(region, test::hidden_target(region, seed));
    const Run run = search(subject, region, problem, {budget}, seed);
    RecordingCost cost(27, problem);
    mean += run.result.cost / kSeeds;
    baseline += RandomSearch({}).minimize(cost, region, {budget}, seed).cost / kSeeds;
  }
  require(mean < baseline, "mean cost " + std::to_string(mean) + " on a sphere in 27 dimensions (" +
                               std::to_string(budget) + " evaluations), random search " +
                               std::to_string(baseline));
}

/// Checks an optimizer that needs a device. Returns false if there is none to search on.
bool check_device(Report& report, const Subject& subject) {
  report.row("a cost that is not on a device is refused", [&] {
    const SearchRegion region = test::tracking_region(7);
    RecordingCost cost(7, test::sphere(region, region.start));
    try {
      subject.make<Optimizer>()->minimize(cost, region, {10}, 1);
    } catch (const DeviceError&) {
      return;
    }
    throw Violation("it was accepted, expected a DeviceError");
  });
  report.row("it says that it needs a device", [&] {
    require(subject.make<Optimizer>()->requirements().device, "requirements().device is false");
  });
  const std::string why = cuda::why_no_device();
  if (!why.empty()) report.row("it searches on a device", [&] { throw Skipped(why); });
  return why.empty();
}

void check_residuals(const Subject& subject) {
  const auto optimizer = subject.make<Optimizer>();
  if (!optimizer->requirements().least_squares) throw Skipped("it does without");
  const SearchRegion region = test::tracking_region(7);
  RecordingCost cost(7, test::sphere(region, region.start));
  cost.has_residuals = false;
  try {
    optimizer->minimize(cost, region, {10}, 1);
  } catch (const ConfigError&) {
    return;
  }
  throw Violation("it was accepted, expected a ConfigError");
}

}  // namespace

void check_optimizer(Report& report, const Subject& subject) {
  if (!check_parameters<Optimizer>(report, subject)) return;
  if (subject.claims("needs_device") && !check_device(report, subject)) return;
  report.row("it needs what its capabilities claim", [&] {
    require(subject.make<Optimizer>()->requirements().least_squares ||
                !subject.claims("needs_least_squares"),
            "they claim needs_least_squares, and requirements().least_squares is false");
  });
  report.row("a cost without residuals is refused where they are needed",
             [&] { check_residuals(subject); });
  report.row("the default budget is at least one evaluation", [&] {
    require(subject.make<Optimizer>()->default_evaluations() >= 1, "it is below 1");
  });
  std::vector<Run> runs;
  report.row("it searches in 1 to 54 dimensions with 1 to 1024 evaluations",
             [&] { runs = searches_of_all_sizes(subject); });
  const auto each = [&](void (*check)(const Run&)) {
    if (runs.empty()) throw Skipped("there are no searches to look at");
    std::ranges::for_each(runs, check);
  };
  report.row("the start is evaluated first", [&] { each(check_start); });
  report.row("the budget of evaluations is kept", [&] { each(check_budget); });
  report.row("evaluations are counted", [&] { each(check_count); });
  report.row("all points are within the bounds", [&] { each(check_bounds); });
  report.row("the best point evaluated is returned", [&] { each(check_best); });
  report.row("equal seeds give equal searches", [&] { check_repeatable(subject); });
  report.row("infinite costs are survived", [&] { check_infeasible(subject); });
  report.row("a flat objective is survived", [&] {
    check_all(search(subject, test::tracking_region(27),
                     [](const Eigen::VectorXd&) { return 0.25; }, {500}));
  });
  report.row("dimensions without room stay as they are", [&] {
    SearchRegion region = test::tracking_region(12);
    for (const int d : {0, 5, 11}) region.lower[d] = region.upper[d] = region.start[d];
    check_all(search(subject, region, test::sphere(region, region.start.array() + 0.1), {300}));
  });
  report.row("exceptions of the cost pass through", [&] { check_exceptions(subject); });
  report.row("a budget of time ends the search", [&] { check_time(subject); });
  report.row("random search is worse at equal evaluations",
             [&] { check_against_random_search(subject); });
}

}  // namespace hypotrack::contract
