#include "session/checked_objective.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "hypotrack/cuda/device_objective.hpp"
#include "hypotrack/error.hpp"
#include "plugin/plugin_call.hpp"

namespace hypotrack::internal {
namespace {

/// Returns whether all numbers are finite: times 0, others are NaN. Eigen sums with SIMD.
bool all_finite(std::span<const float> numbers) {
  const Eigen::Map<const Eigen::ArrayXf> all(numbers.data(), std::ssize(numbers));
  return !std::isnan((all * 0.0F).sum());
}

}  // namespace

CheckedObjective::CheckedObjective(std::unique_ptr<Objective> objective, std::string who)
    : objective_(std::move(objective)),
      refines_start_(dynamic_cast<const RefinesStart*>(objective_.get())),
      batched_(dynamic_cast<const BatchObjective*>(objective_.get())),
      who_(std::move(who)) {
  residuals_ = detail::call_plugin(who_, [&] { return objective_->residual_term(); });
}

void CheckedObjective::prepare(const Observation& observation) {
  const TimeSum::Scope time(times_->prepare);
  detail::call_plugin(who_, [&] { objective_->prepare(observation); });
  dimension_ = observation.start.size();
}

double CheckedObjective::cost(const RenderedHypothesis& hypothesis) const {
  const TimeSum::Scope time(times_->cost);
  return checked(detail::call_plugin(who_, [&] { return objective_->cost(hypothesis); }));
}

void CheckedObjective::costs(std::span<const RenderedHypothesis> hypotheses,
                             std::span<double> costs) const {
  const TimeSum::Scope time(times_->cost);
  detail::call_plugin(who_, [&] { batched_->costs(hypotheses, costs); });
  for (const double cost : costs) checked(cost);
}

double CheckedObjective::checked(double cost) const {
  if (cost >= std::numeric_limits<double>::lowest()) return cost;  // NaN goes on
  throw PluginError(
      fmt::format("{}: the cost of a hypothesis is {}, expected a number or +infinity; this is a "
                  "bug in the objective",
                  who_, cost));
}

double CheckedObjective::cost_and_residuals(const RenderedHypothesis& hypothesis,
                                            std::span<float> residuals) const {
  const TimeSum::Scope time(times_->cost);
  const double cost = checked(detail::call_plugin(
      who_, [&] { return objective_->cost_and_residuals(hypothesis, residuals); }));
  if (std::isfinite(cost)) check_finite(residuals, "residuals");
  return cost;
}

std::vector<PixelMap> CheckedObjective::maps(const RenderedHypothesis& hypothesis) const {
  return detail::call_plugin(who_, [&] { return objective_->maps(hypothesis); });
}

std::unique_ptr<cuda::DeviceObjective> CheckedObjective::on_device() const {
  return detail::call_plugin(who_, [&] { return objective_->on_device(); });
}

Eigen::VectorXd CheckedObjective::refined_start() const {
  if (!refines_start_) return {};
  Eigen::VectorXd out = detail::call_plugin(who_, [&] { return refines_start_->refined_start(); });
  if (out.size() == 0 || (out.size() == dimension_ && out.allFinite())) return out;
  throw PluginError(
      fmt::format("{}: its refined start has {} numbers{}, expected {} finite ones; this is a bug "
                  "in the objective",
                  who_, out.size(), out.allFinite() ? "" : ", not all finite", dimension_));
}

std::int64_t CheckedObjective::residual_count() const {
  constexpr std::int64_t kMost = std::int64_t{1} << 30;
  const std::int64_t count =
      detail::call_plugin(who_, [&] { return residuals_->residual_count(); });
  if (count < 0 || count > kMost)
    throw PluginError(
        fmt::format("{}: has {} residuals, expected 0 to {}; this is a bug in the objective", who_,
                    count, kMost));
  return count;
}

void CheckedObjective::write_residuals(const RenderedHypothesis& hypothesis,
                                       std::span<float> residuals) const {
  const TimeSum::Scope time(times_->cost);
  detail::call_plugin(who_, [&] { residuals_->write_residuals(hypothesis, residuals); });
  check_finite(residuals, "residuals");
}

std::span<const int> CheckedObjective::pixel_views() const {
  return detail::call_plugin(who_, [&] { return residuals_->pixel_views(); });
}

void CheckedObjective::write_slopes(const RenderedHypothesis& hypothesis, std::size_t i,
                                    std::span<float> residuals, std::span<float> slopes) const {
  const TimeSum::Scope time(times_->cost);
  detail::call_plugin(who_, [&] { residuals_->write_slopes(hypothesis, i, residuals, slopes); });
  check_finite(residuals, "residuals");
  check_finite(slopes, "slopes of residuals");
}

void CheckedObjective::write_jacobian(const RenderedHypothesis& hypothesis,
                                      std::span<float> residuals, Jacobian& jacobian) const {
  const TimeSum::Scope time(times_->cost);
  const Eigen::Index rows = jacobian.rows(), columns = jacobian.cols();
  detail::call_plugin(who_, [&] { residuals_->write_jacobian(hypothesis, residuals, jacobian); });
  if (jacobian.rows() != rows || jacobian.cols() != columns)
    throw PluginError(
        fmt::format("{}: its Jacobian is {} x {}, expected {} x {} (residuals x numbers of the "
                    "state); this is a bug in the objective",
                    who_, jacobian.rows(), jacobian.cols(), rows, columns));
  check_finite(residuals, "residuals");
  const auto size = static_cast<std::size_t>(jacobian.size());
  if (all_finite({jacobian.data(), size})) return;
  Eigen::Index i = 0;
  while (std::isfinite(jacobian.data()[i])) ++i;
  throw PluginError(fmt::format(
      "{}: its Jacobian has {} for residual {} of {} and number {} of {} of the state, expected "
      "finite numbers; this is a bug in the objective",
      who_, jacobian.data()[i], i / columns, rows, i % columns, columns));
}

void CheckedObjective::check_finite(std::span<const float> numbers, const char* what) const {
  if (all_finite(numbers)) return;
  std::size_t i = 0;
  while (std::isfinite(numbers[i])) ++i;
  throw PluginError(
      fmt::format("{}: its {} have {} in place {} of {}, expected finite numbers; this is a bug in "
                  "the objective",
                  who_, what, numbers[i], i, numbers.size()));
}

}  // namespace hypotrack::internal
