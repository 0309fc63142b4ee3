#include "track/smooth/fixed_lag_smoother.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "cost/term_residuals.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::internal {
namespace {

/// Multiplies the weights of terms that look at the pose only.
std::vector<ObjectiveTerm> with_prior(std::vector<ObjectiveTerm> terms, double share) {
  for (ObjectiveTerm& term : terms)
    if (term.objective && !term.objective->needs_rendering()) term.weight *= share;
  return terms;
}

const FixedLagSettings& checked(const FixedLagSettings& settings,
                                const std::vector<ObjectiveTerm>& terms) {
  if (const std::string why = TermResiduals::why_none(terms); !why.empty())
    throw ConfigError("fixed-lag smoothing needs residuals: " + why);
  if (settings.lag > settings.window / 2)
    throw ConfigError(
        fmt::format("smoothing.fixed_lag.lag_s is {}, more than half of "
                    "smoothing.fixed_lag.window_s, which is {}; expected {} at "
                    "most, or a longer window",
                    settings.lag, settings.window, settings.window / 2));
  return settings;
}

constexpr std::size_t kContext = 2;  // settled states that constrain the motion of the next window
constexpr int kTurns = 2;            // windows that a frame may be in

}  // namespace

FixedLagSmoother::FixedLagSmoother(const Scene& scene, std::vector<ObjectiveTerm> terms,
                                   const EvaluateSettings& evaluate,
                                   const FixedLagSettings& settings, bool highlights)
    : scene_(scene),
      settings_(checked(settings, terms)),
      cost_(scene, with_prior(std::move(terms), settings.prior), evaluate,
            {.least_squares = true, .jacobian = Linearization::welcome}),
      motion_(scene, settings),
      highlights_(highlights ? std::make_optional<TileHighlights>(scene) : std::nullopt),
      fit_(scene, *cost_, motion_, highlights_ ? &*highlights_ : nullptr) {
  const std::int64_t least = 2 * kTurns * fit_.evaluations_per_linearization();
  if (settings_.evaluations < least)
    throw ConfigError(fmt::format(
        "smoothing.fixed_lag.evaluations is {}; expected {} or more, because each of the {} "
        "windows that a "
        "frame may be in takes two linearisations, of {} evaluations with these objectives on this "
        "backend",
        settings_.evaluations, least, kTurns, fit_.evaluations_per_linearization()));
}

void FixedLagSmoother::add(FrameTiles tiles, const TimedState& found) {
  if (tiles) {
    FrameContext& context = tiles->context;
    context.no_motion_prior = true;
    context.previous = nullptr;
    context.seconds_since_previous = FrameContext().seconds_since_previous;
  }
  tiles_.push_back(std::move(tiles));
  states_.push_back(found);
  evaluations_.push_back(0);
  const double now = found.time;
  if (now - states_[fixed_].time < settings_.window) return;
  const auto recent = std::ranges::find_if(
      states_.begin() + static_cast<std::ptrdiff_t>(fixed_), states_.end(),
      [&](const TimedState& state) { return now - state.time < settings_.lag; });
  settle(static_cast<std::size_t>(recent - states_.begin()));
}

std::int64_t FixedLagSmoother::improve() {
  const auto once = [&] {
    return fit_.improve(states_, tiles_, fixed_, settings_.evaluations / kTurns);
  };
  try {
    return once();
  } catch (const DeviceError& error) {
    cost_.leave_device(error);
  }
  fit_ = TrajectoryFit(scene_, *cost_, motion_, highlights_ ? &*highlights_ : nullptr);
  return once();
}

void FixedLagSmoother::settle(std::size_t count) {
  const std::int64_t taken = improve();
  for (std::size_t i = fixed_; i < states_.size(); ++i)
    if (tiles_[i]) evaluations_[i] += taken;
  for (std::size_t i = fixed_; i < count; ++i)
    settled_.push_back({states_[i].state, evaluations_[i]});
  const auto gone = static_cast<std::ptrdiff_t>(count - std::min(count, kContext));
  states_.erase(states_.begin(), states_.begin() + gone);
  tiles_.erase(tiles_.begin(), tiles_.begin() + gone);
  evaluations_.erase(evaluations_.begin(), evaluations_.begin() + gone);
  fixed_ = std::min(count, kContext);
}

std::vector<FixedLagSmoother::Settled> FixedLagSmoother::take() {
  return std::exchange(settled_, {});
}

std::vector<FixedLagSmoother::Settled> FixedLagSmoother::finish() {
  settle(states_.size());
  return take();
}

}  // namespace hypotrack::internal
