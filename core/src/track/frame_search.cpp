#include "track/frame_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hypotrack/error.hpp"
#include "hypotrack/search.hpp"
#include "track/state_cost.hpp"

namespace hypotrack {
namespace {

/// Where no term looks at pictures, their colours are nobody's business.
PhotometricSettings of_pictures(PhotometricSettings settings,
                                const std::vector<ObjectiveTerm>& terms) {
  settings.match = settings.match && look_at_pictures(terms);
  return settings;
}

}  // namespace

FrameSearch::FrameSearch(const Scene& scene, TrackerParts& parts)
    : settings_(parts.search),
      tiles_(scene, parts.cameras, parts.tile),
      photometric_(scene, of_pictures(parts.photometric, parts.objective)),
      space_(scene, parts.search),
      evaluator_(scene, parts.objective, parts.evaluate, residual_use(parts)),
      optimizer_(std::move(parts.optimizer)) {
  if (const std::string why = optimizer_->needs_device(); !why.empty() && !evaluator_.on_device())
    throw DeviceError(why);
}

void FrameSearch::look(const Frame& frame, const Eigen::VectorXd& start, bool is_guess) {
  plan_ = tiles_.plan(frame, start);
  if (!photometric_.knows()) photometric_.begin(tiles_, frame, plan_, start);
  photometric_.apply(plan_);
  photometric_.apply_highlights(plan_, start);
  plan_.header.start_is_guess = is_guess;
  evaluator_.prepare(tiles_, frame, plan_);
}

void FrameSearch::take_in(const TileMaker& tiles, const Frame& frame, TilePlan plan) {
  photometric_.apply(plan);
  evaluator_.prepare(tiles, frame, std::move(plan));
}

Eigen::VectorXd FrameSearch::cheapest(const Eigen::MatrixXd& states) {
  if (states.cols() == 1) return states;
  Eigen::VectorXd costs(states.cols());
  evaluator_.evaluate(states, costs);
  Eigen::Index best = 0;
  costs.minCoeff(&best);
  return states.col(best);
}

Found FrameSearch::from(const Eigen::VectorXd& prior, const Budget& budget,
                        const std::optional<Reach>& reach, std::uint64_t seed) {
  StateCost cost(space_, prior, evaluator_);
  const OptimizerResult result =
      optimizer_->minimize(cost, space_.region(prior, reach), budget, seed);
  if (!result.point.allFinite() || std::isnan(result.cost))
    throw PluginError(
        fmt::format("the optimizer's answer of cost {} has numbers that are none; this is a bug in "
                    "the optimizer",
                    result.cost));
  return {space_.states(result.point, prior), result.cost, result.evaluations};
}

Found FrameSearch::from_guess(const Frame& frame, const Eigen::VectorXd& start,
                              const Budget& budget, std::uint64_t seed) {
  look(frame, start, true);
  const double kept = settings_.second_look;
  Budget first = budget, second = budget;
  first.evaluations -= static_cast<std::int64_t>(kept * static_cast<double>(budget.evaluations));
  first.seconds *= 1 - kept;
  Found found = from(start, first, std::nullopt, seed);
  second.evaluations -= found.evaluations;
  if (kept == 0 || second.evaluations < 1 || tiles_.visible_share(found.state) == 0) return found;
  second.seconds *= kept;
  photometric_.forget();
  look(frame, found.state, false);
  const std::int64_t before = found.evaluations;
  found = from(found.state, second, std::nullopt, seed_of_part(seed, 1));
  found.evaluations += before;
  return found;
}

void FrameSearch::learn(const Frame& frame, const Eigen::VectorXd& state) {
  photometric_.learn(tiles_, frame, plan_, state);
}

Observation FrameSearch::seen(const Frame& frame) const {
  TilePlan plan = plan_;
  for (CutPlan& cut : plan.cuts) cut.brightness = cv::Mat();
  return tiles_.cut(frame, plan);
}

}  // namespace hypotrack
