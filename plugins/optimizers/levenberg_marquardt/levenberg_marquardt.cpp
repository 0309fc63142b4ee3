#include "levenberg_marquardt.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "damped_least_squares.hpp"
#include "hypotrack/gpu/device_cost.hpp"

namespace hypotrack {
namespace {

using Wants = DampedLeastSquares::Wants;

std::vector<DampedLeastSquares*> those_that_want(std::vector<DampedLeastSquares>& searches,
                                                 Wants wanted) {
  std::vector<DampedLeastSquares*> out;
  for (DampedLeastSquares& search : searches) {
    if (search.wants() == wanted) out.push_back(&search);
  }
  return out;
}

/// Evaluates what all searches want in one batch.
void evaluate(CostFunction& cost, const std::vector<DampedLeastSquares*>& searches) {
  Eigen::Index count = 0;
  for (const DampedLeastSquares* search : searches) count += search->points().cols();
  Eigen::MatrixXd points(cost.dimension(), count);
  Eigen::Index first = 0;
  for (const DampedLeastSquares* search : searches) {
    points.middleCols(first, search->points().cols()) = search->points();
    first += search->points().cols();
  }
  Eigen::VectorXd costs(count);
  cost.evaluate(points, costs);
  first = 0;
  for (DampedLeastSquares* search : searches) {
    const Eigen::Index own = search->points().cols();
    search->take(costs.segment(first, own));
    first += own;
  }
}

void linearize(ResidualCost& residuals, const std::vector<DampedLeastSquares*>& searches) {
  std::vector<Neighbourhood> points;
  for (const DampedLeastSquares* search : searches) points.push_back(search->neighbourhood());
  const std::vector<NormalEquations> equations = residuals.linearize_each(points);
  for (std::size_t i = 0; i < searches.size(); ++i) searches[i]->take(equations[i]);
}

/// Runs searches with analytic Jacobians in step.
void run_in_step(CostFunction& cost, ResidualCost& residuals, const Deadline& deadline,
                 std::vector<DampedLeastSquares>& searches) {
  evaluate(cost, those_that_want(searches, Wants::costs));
  while (!deadline.passed()) {
    const auto to_evaluate = those_that_want(searches, Wants::costs);
    if (!to_evaluate.empty()) {
      evaluate(cost, to_evaluate);
      continue;
    }
    const auto to_linearize = those_that_want(searches, Wants::equations);
    if (to_linearize.empty()) return;
    linearize(residuals, to_linearize);
  }
}

/// Searches all regions with steps that stay on the GPU. Returns nothing if the cost has no such
/// search.
std::vector<OptimizerResult> descend_on_device(CostFunction& cost,
                                               std::span<const SearchRegion> regions,
                                               const DampedSettings& settings,
                                               const Deadline& deadline) {
  auto* const descent = dynamic_cast<cuda::DescentCost*>(cost.device());
  if (!descent) return {};
  std::vector<OptimizerResult> out(regions.size());
  std::vector<cuda::Descent> searches;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    const SearchRegion& region = regions[k];
    out[k].point.resize(region.start.size());
    searches.push_back({region.start.data(), region.lower.data(), region.upper.data(),
                        region.spread.data(), out[k].point.data()});
  }
  if (!descent->descend(settings, cost.dimension(), searches, [&] { return deadline.passed(); }))
    return {};
  for (std::size_t k = 0; k < regions.size(); ++k) {
    out[k].cost = searches[k].cost;
    out[k].evaluations = searches[k].evaluations;
  }
  return out;
}

/// Runs a search with numerical Jacobians.
void run_numerically(ResidualCost& residuals, const SearchRegion& region, const Deadline& deadline,
                     DampedLeastSquares& search) {
  const auto differences = residuals.differences();
  const auto follow = [&](Eigen::Index moved_to) {
    if (moved_to >= 0) differences->move_to(moved_to);
  };
  const auto evaluate_points = [&] {
    Eigen::VectorXd costs(search.points().cols());
    differences->evaluate(search.points(), costs);
    follow(search.take(costs));
  };
  evaluate_points();
  while (!deadline.passed() && search.wants() != Wants::nothing) {
    if (search.wants() == Wants::costs) {
      evaluate_points();
      continue;
    }
    const Neighbourhood at = search.neighbourhood();
    Eigen::VectorXd costs(at.steps.size());
    const NormalEquations equations = differences->normal_equations(
        at.points.rightCols(at.steps.size()), scale_per_spread(region, at.steps), costs);
    follow(search.take(equations, at, costs));
  }
}

}  // namespace

std::span<const std::string_view> enum_names(JacobianMethod) {
  static constexpr std::array<std::string_view, 3> kNames{"auto", "numerical", "analytic"};
  return kNames;
}

Requirements LevenbergMarquardt::requirements() const {
  Requirements out{.least_squares = true, .jacobian = Linearization::welcome};
  if (params_.jacobian == JacobianMethod::numerical) out.jacobian = Linearization::unused;
  if (params_.jacobian == JacobianMethod::analytic) out.jacobian = Linearization::needed;
  return out;
}

bool LevenbergMarquardt::is_analytic(const ResidualCost& residuals) const {
  return params_.jacobian == JacobianMethod::analytic ||
         (params_.jacobian == JacobianMethod::automatic && residuals.can_linearize());
}

std::vector<OptimizerResult> LevenbergMarquardt::search_each(CostFunction& cost,
                                                             std::span<const SearchRegion> regions,
                                                             const Budget& budget) const {
  ResidualCost* residuals = cost.residuals();
  check_requirements(requirements(), residuals, nullptr);
  using Source = DampedLeastSquares::Source;
  const bool analytic = is_analytic(*residuals);
  const Source source = !analytic                       ? Source::differences
                        : residuals->draws_neighbours() ? Source::mixed
                                                        : Source::analytic;
  const Deadline deadline(budget.seconds);
  for (const SearchRegion& region : regions) check_search(cost, region, budget);
  // Whoever watches a search sees the batches of one on the host: the same search, up to rounding.
  if (source == Source::analytic && !cost.is_watched()) {
    const DampedSettings settings =
        damped_settings(params_, source, budget.evaluations, cost.dimension());
    auto found = descend_on_device(cost, regions, settings, deadline);
    if (!found.empty()) return found;
  }
  std::vector<DampedLeastSquares> searches;
  for (const SearchRegion& region : regions)
    searches.emplace_back(region, budget.evaluations, params_, source);
  if (analytic) {
    run_in_step(cost, *residuals, deadline, searches);
  } else {
    for (std::size_t k = 0; k < regions.size(); ++k) {
      const Deadline own(deadline.left() / static_cast<double>(regions.size() - k));
      run_numerically(*residuals, regions[k], own, searches[k]);
    }
  }
  std::vector<OptimizerResult> out;
  for (const DampedLeastSquares& search : searches) out.push_back(search.result());
  return out;
}

std::vector<OptimizerResult> LevenbergMarquardt::search_from_starts(
    CostFunction& cost, std::span<const SearchRegion> regions, const Budget& budget,
    const std::vector<std::uint64_t>& seeds) const {
  const auto starts = std::min<std::int64_t>(params_.restarts, budget.evaluations);
  if (starts <= 1) return search_each(cost, regions, budget);
  std::vector<SearchRegion> all;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    const Eigen::MatrixXd points =
        StartPoints(regions[k], params_.around, seeds[k]).points(0, starts);
    for (std::int64_t i = 0; i < starts; ++i) {
      all.push_back(regions[k]);
      all.back().start = points.col(i);
    }
  }
  Budget each = budget;
  each.evaluations = budget.evaluations / starts;
  const std::vector<OptimizerResult> found = search_each(cost, all, each);
  std::vector<OptimizerResult> out;
  for (auto own = found.begin(); own != found.end(); own += starts) {
    OptimizerResult best = *std::min_element(
        own, own + starts, [](const auto& a, const auto& b) { return a.cost < b.cost; });
    best.evaluations = 0;
    for (auto it = own; it != own + starts; ++it) best.evaluations += it->evaluations;
    out.push_back(std::move(best));
  }
  return out;
}

OptimizerResult LevenbergMarquardt::minimize(CostFunction& cost, const SearchRegion& region,
                                             const Budget& budget, std::uint64_t seed) {
  check_search(cost, region, budget);
  return search_from_starts(cost, {&region, 1}, budget, {seed}).front();
}

std::vector<OptimizerResult> LevenbergMarquardt::minimize_each(
    CostFunction& cost, std::span<const SearchRegion> regions, const Budget& budget,
    std::uint64_t seed) {
  std::vector<std::uint64_t> seeds;
  for (std::uint32_t k = 0; k < regions.size(); ++k) seeds.push_back(seed_of_part(seed, k));
  return search_from_starts(cost, regions, budget, seeds);
}

}  // namespace hypotrack
