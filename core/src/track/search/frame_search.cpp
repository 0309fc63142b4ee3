#include "track/search/frame_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/profile.hpp"
#include "cost/search_clock.hpp"
#include "hypotrack/api/stop.hpp"
#include "hypotrack/plugin/search.hpp"
#include "plugin/plugin_call.hpp"
#include "track/search/search_cost.hpp"

namespace hypotrack::internal {
namespace {

/// Turns colour matching off where no term looks at pictures.
PhotometricSettings of_pictures(PhotometricSettings settings,
                                const std::vector<ObjectiveTerm>& terms) {
  settings.match = settings.match && look_at_pictures(terms);
  return settings;
}

}  // namespace

FrameSearch::FrameSearch(const Scene& scene, TrackerParts& parts)
    : scene_(scene),
      settings_(parts.search),
      nowhere_(parts.cameras.at(0).camera_from_world.inverse() * Eigen::Vector3d(0, 0, -10)),
      shown_(scene.items().size(), true),
      moving_(shown_),
      tiles_(scene, parts.cameras, parts.tile),
      photometric_(scene, of_pictures(parts.photometric, parts.objective)),
      space_(scene, parts.search),
      background_(joined_use(parts.objective).background
                      ? std::make_optional<StillBackground>(scene, parts.cameras)
                      : std::nullopt),
      terms_(parts.objective),
      cost_(scene, parts.objective, parts.evaluate, requirements_of(parts)),
      optimizer_(std::move(parts.optimizer)),
      clock_(parts.clock),
      keeps_tiles_(joined_use(parts.objective).previous) {}

void FrameSearch::show(const std::vector<bool>& models, const std::vector<bool>& moving) {
  const std::vector<bool>& moves = moving.empty() ? models : moving;
  if (models == shown_ && moves == moving_) return;
  shown_ = models;
  moving_ = moves;
  std::vector<bool> hidden = models;
  hidden.flip();
  tiles_.leave_out(hidden);
  space_ = SearchSpace(scene_, settings_, moves);
}

Eigen::VectorXd FrameSearch::drawn(Eigen::VectorXd state) const {
  for (std::size_t m = 0; m < shown_.size(); ++m)
    if (!shown_[m]) state.segment<3>(scene_.items()[m].offset) = nowhere_;
  return state;
}

void FrameSearch::remember(std::shared_ptr<PreviousSolution> answer, const Frame* frame) {
  const ProfiledPart part("keep pictures");
  if (answer && frame && keeps_tiles_) {
    TilePlan plan = tiles_.plan(*frame, answer->state);
    photometric_.apply(plan);
    answer->views = tiles_.resample(*frame, plan).views;
    for (TileView& view : answer->views) view = {view.camera, view.color, view.valid, {}, {}, {}};
  }
  previous_ = std::move(answer);
}

void FrameSearch::add_previous(const Frame& frame, TilePlan& plan) const {
  FrameContext& context = plan.header.context;
  if (!previous_ || context.no_motion_prior) return;
  context.previous = previous_;
  context.seconds_since_previous = frame.time - previous_->time;
}

void FrameSearch::add_hidden(TilePlan& plan) const {
  if (!hidden_) return;
  for (std::size_t i = 0; i < plan.views.size(); ++i)
    plan.views[i].hidden = hidden_->in_tile(i, plan.header.views[i].camera);
}

void FrameSearch::look(const Frame& frame, const Eigen::VectorXd& start, bool is_guess) {
  const ProfiledPart part("prepare");
  plan_ = tiles_.plan(frame, start);
  const Eigen::VectorXd posed = drawn(start);
  if (!photometric_.knows()) photometric_.begin(tiles_, frame, plan_, posed);
  photometric_.apply(plan_);
  photometric_.apply_highlights(plan_, posed);
  add_hidden(plan_);
  // Put hidden models where a shown one is, so that the tile's depths are those of shown models.
  for (std::size_t m = 0; m < shown_.size(); ++m)
    if (!shown_[m]) plan_.header.start.segment<3>(scene_.items()[m].offset) = some_position(start);
  plan_.header.context.start_is_guess = is_guess;
  add_previous(frame, plan_);
  context_ = plan_.header.context;
  if (background_) background_->add_to(plan_, tiles_.resamplers());
  cost_->prepare(tiles_, frame, plan_);
  is_fresh_ = true;
}

Eigen::VectorXd FrameSearch::refined(const Eigen::VectorXd& prior) {
  if (!std::exchange(is_fresh_, false)) return prior;
  for (const ObjectiveTerm& term : terms_) {
    const Eigen::VectorXd start = term.objective->refined_start();
    if (start.size() == 0) continue;
    Eigen::VectorXd out = prior;
    for (std::size_t m = 0; m < moving_.size(); ++m) {
      const Scene::Item& item = scene_.items()[m];
      if (shown_[m] && moving_[m])
        out.segment(item.offset, item.model->dimension()) =
            start.segment(item.offset, item.model->dimension());
    }
    return out;
  }
  return prior;
}

void FrameSearch::take_in(const TileMaker& tiles, const Frame& frame, TilePlan plan) {
  photometric_.apply(plan);
  add_hidden(plan);
  add_previous(frame, plan);
  context_ = plan.header.context;
  if (background_) background_->add_to(plan, tiles.resamplers());
  cost_->prepare(tiles, frame, std::move(plan));
}

Eigen::Vector3d FrameSearch::some_position(const Eigen::VectorXd& state) const {
  const auto first = std::ranges::find(shown_, true) - shown_.begin();
  return state.segment<3>(scene_.items()[static_cast<std::size_t>(first)].offset);
}

Eigen::VectorXd FrameSearch::costs(Eigen::MatrixXd states) {
  for (auto state : states.colwise()) state = drawn(state);
  Eigen::VectorXd out(states.cols());
  cost_->evaluate(states, out);
  return out;
}

void FrameSearch::trace(FrameTrace* trace, const Frame* frame) {
  trace_ = trace;
  truth_ = frame && frame->truth && frame->truth->state.size() > 0 ? &*frame->truth : nullptr;
}

double FrameSearch::truth_cost() {
  if (!truth_) return std::numeric_limits<double>::quiet_NaN();
  for (std::size_t m = 0; m < shown_.size(); ++m)
    if (shown_[m] && !truth_->absent.empty() && truth_->absent[m])
      return std::numeric_limits<double>::quiet_NaN();
  return costs(truth_->state)[0];
}

Eigen::VectorXd FrameSearch::cheapest(const Eigen::MatrixXd& states) {
  if (states.cols() == 1) return states;
  Eigen::Index best = 0;
  costs(states).minCoeff(&best);
  return states.col(best);
}

OptimizerResult FrameSearch::minimize(SearchCost& cost, const SearchRegion& region,
                                      const Budget& budget, std::uint64_t seed) {
  const ProfiledPart part("search");
  const std::string who = detail::label_or(*optimizer_, "the optimizer");
  const detail::RunningPlugin running(who.c_str());
  const ClockScope clock(clock_);
  OptimizerResult answer;
  try {
    answer = optimizer_->minimize(cost, region, budget, seed);
  } catch (...) {
    if (cost.tally().failed) throw;
    detail::rethrow_from(who);
  }
  check_stop();  // in case the optimizer caught it
  check_answer(answer, cost.tally(), region, budget, who);
  return answer;
}

Found FrameSearch::from(const Eigen::VectorXd& prior, const Budget& budget,
                        const std::optional<Reach>& reach, std::uint64_t seed) {
  const Eigen::VectorXd posed = drawn(refined(prior));
  RecordedSearch* record = record_ ? &record_->emplace_back() : nullptr;
  OptimizerTrace* traced =
      trace_ ? &trace_->searches.emplace_back(OptimizerTrace{.dimension = space_.dimension()})
             : nullptr;
  std::optional<OptimizerTracer> tracer;
  if (traced) tracer.emplace(*traced);
  SearchCost cost(*cost_, space_, posed, record, tracer ? &*tracer : nullptr);
  SearchRegion region = space_.region(posed, reach);
  if (context_.previous) {
    region.previous = space_.point(context_.previous->state, posed);
    region.seconds_since_previous = context_.seconds_since_previous;
  }
  const OptimizerResult result = minimize(cost, region, budget, seed);
  if (traced) {
    tracer->add(result.evaluations, result.cost);  // of a search in GPU memory, the only step
    traced->truth_cost = truth_cost();
  }
  Found found{space_.states(result.point, posed), result.cost, result.evaluations};
  if (record) {
    record->state = found.state;
    record->cost = found.cost;
  }
  for (std::size_t m = 0; m < shown_.size(); ++m)
    if (!shown_[m]) {
      const Eigen::Index offset = scene_.items()[m].offset;
      found.state.segment<3>(offset) = prior.segment<3>(offset);
    }
  return found;
}

Found FrameSearch::settled(const Eigen::VectorXd& start, const Budget& budget, std::uint64_t seed) {
  const Found first = from(start, budget, std::nullopt, seed_of_part(seed, 0));
  // The second search needs its fallback stage only where it gets worse.
  Budget again = budget;
  again.usual_cost = first.cost;
  Found found = from(first.state, again, std::nullopt, seed_of_part(seed, 1));
  found.evaluations += first.evaluations;
  return found;
}

Found FrameSearch::from_guess(const Frame& frame, const Eigen::VectorXd& start,
                              const Budget& budget, std::uint64_t seed) {
  look(frame, start, true);
  const double kept = settings_.second_search;
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
  {
    const ProfiledPart part("take colours");
    photometric_.learn(tiles_, frame, plan_, drawn(state));
  }
  const bool all = std::ranges::find(shown_, false) == shown_.end();
  const ProfiledPart part("learn the background");
  if (background_ && all) background_->learn(frame, state);  // a lost model may be anywhere
}

Observation FrameSearch::seen(const Frame& frame) const {
  TilePlan plan = plan_;
  for (ResamplePlan& view : plan.views) view.brightness = cv::Mat();
  return tiles_.resample(frame, plan);
}

}  // namespace hypotrack::internal
