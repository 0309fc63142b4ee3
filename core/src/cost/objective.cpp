#include "hypotrack/plugin/objective.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>

#include "cost/term_times.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/gpu/device_objective.hpp"
#include "plugin/plugin_call.hpp"

namespace hypotrack {
namespace {

constexpr const char* kUnnamed = "the objective";

/// Returns whether all numbers are finite: times 0, others are NaN. Eigen sums with SIMD.
bool all_finite(std::span<const float> numbers) {
  const Eigen::Map<const Eigen::ArrayXf> all(numbers.data(), std::ssize(numbers));
  return !std::isnan((all * 0.0F).sum());
}

std::string label_of(const Objective* objective) {
  return objective ? detail::label_or(*objective, kUnnamed) : kUnnamed;
}

double checked_cost(const Objective& objective, double cost) {
  if (cost >= std::numeric_limits<double>::lowest()) return cost;  // NaN goes on
  throw PluginError(
      fmt::format("{}: the cost of a hypothesis is {}, expected a number or +infinity; this is a "
                  "bug in the objective",
                  label_of(&objective), cost));
}

void check_finite(const Objective* objective, std::span<const float> numbers, const char* what) {
  if (all_finite(numbers)) return;
  std::size_t i = 0;
  while (std::isfinite(numbers[i])) ++i;
  throw PluginError(
      fmt::format("{}: its {} have {} in place {} of {}, expected finite numbers; this is a bug in "
                  "the objective",
                  label_of(objective), what, numbers[i], i, numbers.size()));
}

void check_jacobian(const Objective* objective, const Jacobian& jacobian, Eigen::Index rows,
                    Eigen::Index columns) {
  if (jacobian.rows() != rows || jacobian.cols() != columns)
    throw PluginError(
        fmt::format("{}: its Jacobian is {} x {}, expected {} x {} (residuals x numbers of the "
                    "state); this is a bug in the objective",
                    label_of(objective), jacobian.rows(), jacobian.cols(), rows, columns));
  if (all_finite({jacobian.data(), static_cast<std::size_t>(jacobian.size())})) return;
  Eigen::Index i = 0;
  while (std::isfinite(jacobian.data()[i])) ++i;
  throw PluginError(fmt::format(
      "{}: its Jacobian has {} for residual {} of {} and number {} of {} of the state, expected "
      "finite numbers; this is a bug in the objective",
      label_of(objective), jacobian.data()[i], i / columns, rows, i % columns, columns));
}

/// Calls a function of a residual term. Adds its time to `time`, if that is not null.
template <class Function>
decltype(auto) call_term(const Objective* owner, TimeSum* time, Function&& function) {
  const TimeSum::Scope measured(time);
  if (!owner) return std::forward<Function>(function)();
  return detail::call_plugin(*owner, std::forward<Function>(function));
}

}  // namespace

Objective::Objective() : times_(std::make_shared<TermTimes>()) {}
Objective::~Objective() = default;
std::shared_ptr<const TermTimes> Objective::times() const { return times_; }

void Objective::prepare(const Observation& observation) {
  const TimeSum::Scope time(&times_->prepare);
  detail::call_plugin(*this, [&] { do_prepare(observation); });
  dimension_ = observation.start.size();
}

double Objective::cost(const RenderedHypothesis& hypothesis) const {
  const TimeSum::Scope time(&times_->cost);
  return checked_cost(*this, detail::call_plugin(*this, [&] { return do_cost(hypothesis); }));
}

void Objective::costs(std::span<const RenderedHypothesis> hypotheses,
                      std::span<double> costs) const {
  const TimeSum::Scope time(&times_->cost);
  detail::call_plugin(*this, [&] { do_costs(hypotheses, costs); });
  for (const double cost : costs) checked_cost(*this, cost);
}

const ResidualTerm* Objective::residual_term() const {
  const ResidualTerm* term = detail::call_plugin(*this, [&] { return do_residual_term(); });
  // An inner objective's residuals stay those of the objective that a scene names.
  if (term && (!label().empty() || !term->owner_.load(std::memory_order_relaxed)))
    term->owner_.store(this, std::memory_order_relaxed);
  return term;
}

double Objective::cost_and_residuals(const RenderedHypothesis& hypothesis,
                                     std::span<float> residuals) const {
  const TimeSum::Scope time(&times_->cost);
  const double cost = checked_cost(*this, detail::call_plugin(*this, [&] {
    return do_cost_and_residuals(hypothesis, residuals);
  }));
  if (std::isfinite(cost)) check_finite(this, residuals, "residuals");
  return cost;
}

Eigen::VectorXd Objective::refined_start() const {
  Eigen::VectorXd out = detail::call_plugin(*this, [&] { return do_refined_start(); });
  if (out.size() == 0 || (out.size() == dimension_ && out.allFinite())) return out;
  throw PluginError(fmt::format(
      "{}: its refined start has {} numbers{}, expected {} finite ones; this is a bug "
      "in the objective",
      label_of(this), out.size(), out.allFinite() ? "" : ", not all finite", dimension_));
}

std::vector<PixelMap> Objective::maps(const RenderedHypothesis& hypothesis) const {
  return detail::call_plugin(*this, [&] { return do_maps(hypothesis); });
}

std::unique_ptr<cuda::DeviceObjective> Objective::on_device() const {
  return detail::call_plugin(*this, [&] { return do_on_device(); });
}

void Objective::do_costs(std::span<const RenderedHypothesis> hypotheses,
                         std::span<double> costs) const {
  for (std::size_t i = 0; i < costs.size(); ++i) costs[i] = do_cost(hypotheses[i]);
}

double Objective::do_cost_and_residuals(const RenderedHypothesis& hypothesis,
                                        std::span<float> residuals) const {
  do_residual_term()->do_write_residuals(hypothesis, residuals);
  return do_cost(hypothesis);
}

std::vector<PixelMap> Objective::do_maps(const RenderedHypothesis&) const { return {}; }
std::unique_ptr<cuda::DeviceObjective> Objective::do_on_device() const { return nullptr; }

ResidualTerm::~ResidualTerm() = default;

std::int64_t ResidualTerm::residual_count() const {
  constexpr std::int64_t kMost = std::int64_t{1} << 30;
  const Objective* const owner = owner_.load(std::memory_order_relaxed);
  const std::int64_t count = call_term(owner, nullptr, [&] { return do_residual_count(); });
  if (count < 0 || count > kMost)
    throw PluginError(
        fmt::format("{}: has {} residuals, expected 0 to {}; this is a bug in the objective",
                    label_of(owner), count, kMost));
  return count;
}

void ResidualTerm::write_residuals(const RenderedHypothesis& hypothesis,
                                   std::span<float> residuals) const {
  const Objective* const owner = owner_.load(std::memory_order_relaxed);
  call_term(owner, owner ? &owner->times_->cost : nullptr,
            [&] { do_write_residuals(hypothesis, residuals); });
  check_finite(owner, residuals, "residuals");
}

std::span<const int> ResidualTerm::pixel_views() const {
  return call_term(owner_.load(std::memory_order_relaxed), nullptr,
                   [&] { return do_pixel_views(); });
}

void ResidualTerm::write_slopes(const RenderedHypothesis& hypothesis, std::size_t i,
                                std::span<float> residuals, std::span<float> slopes) const {
  const Objective* const owner = owner_.load(std::memory_order_relaxed);
  call_term(owner, owner ? &owner->times_->cost : nullptr,
            [&] { do_write_slopes(hypothesis, i, residuals, slopes); });
  check_finite(owner, residuals, "residuals");
  check_finite(owner, slopes, "slopes of residuals");
}

void ResidualTerm::write_jacobian(const RenderedHypothesis& hypothesis, std::span<float> residuals,
                                  Jacobian& jacobian) const {
  const Eigen::Index rows = jacobian.rows(), columns = jacobian.cols();
  const Objective* const owner = owner_.load(std::memory_order_relaxed);
  call_term(owner, owner ? &owner->times_->cost : nullptr,
            [&] { do_write_jacobian(hypothesis, residuals, jacobian); });
  check_finite(owner, residuals, "residuals");
  check_jacobian(owner, jacobian, rows, columns);
}

std::span<const int> ResidualTerm::do_pixel_views() const {
  throw Error("this objective has no slopes of residuals");
}

void ResidualTerm::do_write_slopes(const RenderedHypothesis&, std::size_t, std::span<float>,
                                   std::span<float>) const {
  throw Error("this objective has no slopes of residuals");
}

void ResidualTerm::do_write_jacobian(const RenderedHypothesis&, std::span<float>, Jacobian&) const {
  throw Error("this objective has no Jacobian of its residuals");
}

}  // namespace hypotrack
