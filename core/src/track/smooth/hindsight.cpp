#include "track/smooth/hindsight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "cost/term_residuals.hpp"
#include "hypotrack/error.hpp"

namespace hypotrack {
namespace {

/// Multiplies the weights of terms that look at the pose only.
std::vector<ObjectiveTerm> with_prior(std::vector<ObjectiveTerm> terms, double share) {
  for (ObjectiveTerm& term : terms)
    if (term.objective && !term.objective->needs_rendering()) term.weight *= share;
  return terms;
}

const HindsightSettings& checked(const HindsightSettings& settings,
                                 const std::vector<ObjectiveTerm>& terms) {
  if (const std::string why = TermResiduals::why_none(terms); !why.empty())
    throw ConfigError("hindsight needs residuals: " + why);
  if (settings.lag > settings.window / 2)
    throw ConfigError(fmt::format(
        "hindsight.lag_s is {}, more than half of hindsight.window_s, which is {}; expected {} at "
        "most, or a longer window",
        settings.lag, settings.window, settings.window / 2));
  return settings;
}

constexpr std::size_t kContext = 2;  // settled moments that constrain the motion of the next window
constexpr int kTurns = 2;            // windows that a frame may be in

}  // namespace

Hindsight::Hindsight(const Scene& scene, std::vector<ObjectiveTerm> terms,
                     const EvaluateSettings& evaluate, const HindsightSettings& settings,
                     bool highlights)
    : settings_(checked(settings, terms)),
      cost_(make_cost(scene, with_prior(std::move(terms), settings.prior), evaluate,
                      {.least_squares = true, .jacobian = Linearization::welcome})),
      motion_(scene, settings),
      highlights_(highlights ? std::make_optional<TileHighlights>(scene) : std::nullopt),
      fit_(scene, *cost_, motion_, highlights_ ? &*highlights_ : nullptr) {
  const std::int64_t least = 2 * kTurns * fit_.evaluations_per_look();
  if (settings_.evaluations < least)
    throw ConfigError(fmt::format(
        "hindsight.evaluations is {}; expected {} or more, because each of the {} windows that a "
        "frame may be in takes two looks, of {} evaluations with these objectives on this backend",
        settings_.evaluations, least, kTurns, fit_.evaluations_per_look()));
}

void Hindsight::add(Sight sight, const Moment& found) {
  if (sight) sight->context.no_motion_prior = true;
  sights_.push_back(std::move(sight));
  moments_.push_back(found);
  evaluations_.push_back(0);
  const double now = found.time;
  if (now - moments_[fixed_].time < settings_.window) return;
  const auto recent =
      std::ranges::find_if(moments_.begin() + static_cast<std::ptrdiff_t>(fixed_), moments_.end(),
                           [&](const Moment& moment) { return now - moment.time < settings_.lag; });
  settle(static_cast<std::size_t>(recent - moments_.begin()));
}

void Hindsight::settle(std::size_t count) {
  const std::int64_t taken =
      fit_.improve(moments_, sights_, fixed_, settings_.evaluations / kTurns);
  for (std::size_t i = fixed_; i < moments_.size(); ++i)
    if (sights_[i]) evaluations_[i] += taken;
  for (std::size_t i = fixed_; i < count; ++i)
    settled_.push_back({moments_[i].state, evaluations_[i]});
  const auto gone = static_cast<std::ptrdiff_t>(count - std::min(count, kContext));
  moments_.erase(moments_.begin(), moments_.begin() + gone);
  sights_.erase(sights_.begin(), sights_.begin() + gone);
  evaluations_.erase(evaluations_.begin(), evaluations_.begin() + gone);
  fixed_ = std::min(count, kContext);
}

std::vector<Hindsight::Settled> Hindsight::take() { return std::exchange(settled_, {}); }

std::vector<Hindsight::Settled> Hindsight::finish() {
  settle(moments_.size());
  return take();
}

}  // namespace hypotrack
