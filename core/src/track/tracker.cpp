#include "track/tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "hypotrack/error.hpp"
#include "hypotrack/search.hpp"
#include "session/displace.hpp"
#include "track/tangent.hpp"

namespace hypotrack {
namespace {

// Frames that are searched from several starts before anything was found.
constexpr int kPatientFrames = 3;
// Frames after a loss in which other poses are looked for although one looks right.
constexpr int kConfirmations = 4;
// Of probability: answers less apart are told by their costs.
constexpr double kAlike = 0.2;
// An answer of this probability is worth searches around it.
constexpr double kHint = 0.02;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A seed of its own for every frame (splitmix64 of both numbers), so that a frame's search does
/// not depend on how many random numbers the frames before it used.
std::uint64_t frame_seed(std::uint64_t seed, int frame) {
  std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * (static_cast<std::uint64_t>(frame) + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Where no term looks at pictures, these say nothing of an answer.
StatusSettings of_pictures(StatusSettings settings, const std::vector<ObjectiveTerm>& terms) {
  settings.evidence = settings.evidence && look_at_pictures(terms);
  return settings;
}

/// How far a scene may be from where it was last seen: a root mean square, metres.
double spread_after(double seconds) {
  constexpr double kAtOnce = 0.03, kPerSecond = 0.3;
  return kAtOnce + kPerSecond * std::max(seconds, 0.0);
}

/// Takes what hindsight may spend off the budget of a search. Throws ConfigError if that would
/// leave it less than half.
void reserve_for(const HindsightSettings& hindsight, Budget& budget) {
  if (budget.evaluations < 2 * hindsight.evaluations)
    throw ConfigError(
        fmt::format("hindsight takes {} evaluations of a frame's budget, which is {}; give "
                    "budget.evaluations {} "
                    "or more, hindsight.evaluations {} or less, or leave hindsight.enabled off",
                    hindsight.evaluations, budget.evaluations, 2 * hindsight.evaluations,
                    budget.evaluations / 2));
  budget.evaluations -= hindsight.evaluations;
}

/// Takes the evaluations that sigmas need off the budget of a search. Throws ConfigError if that
/// would leave it less than half.
void reserve_for(const PoseUncertainty& uncertainty, Budget& budget) {
  const std::int64_t needed = uncertainty.evaluations();
  if (budget.evaluations < 2 * needed)
    throw ConfigError(fmt::format(
        "tracker.uncertainty takes {} evaluations of a frame's budget, which is {}; give "
        "budget.evaluations {} or more, or leave tracker.uncertainty.enabled off",
        needed, budget.evaluations, 2 * needed));
  budget.evaluations -= needed;
}

}  // namespace

Tracker::Tracker(const Scene& scene, TrackerParts parts, Eigen::VectorXd start, std::uint64_t seed)
    : scene_(scene),
      settings_(of_pictures(parts.status, parts.objective)),
      budget_(parts.budget),
      first_(std::move(start)),
      search_(scene, parts),
      judge_(scene, parts.cameras),
      recovery_(scene, parts.cameras, parts.status.recovery),
      monitor_(parts.status),
      landmarks_(landmark_layout(scene.landmark_names())),
      predictor_(scene, parts.search.prediction),
      smoother_(scene, parts.smoothing),
      smoothing_(parts.smoothing.enabled),
      seed_(seed) {
  scene.normalize(first_);
  state_ = kept_.state = output_ = first_;
  if (budget_.evaluations == 0) budget_.evaluations = search_.default_evaluations();
  if (parts.hindsight.enabled) reserve_for(parts.hindsight, budget_);
  if (settings_.uncertainty.enabled)
    reserve_for(uncertainty_.emplace(scene, settings_.uncertainty), budget_);
}

Tracker::~Tracker() {
  if (job_.valid()) job_.wait();
}

std::string Tracker::backend() const { return search_.evaluator().backend(); }

Observation Tracker::seen(const Frame& frame) const { return search_.seen(frame); }

Solution Tracker::track(const Frame& frame) {
  Solution solution;
  solution.frame = frame.index;
  solution.time = frame.time;
  solution.cost = kUnknown;
  if (uncertainty_)
    solution.sigma.setConstant(static_cast<Eigen::Index>(landmarks_.names.size()), kUnknown);
  if (!frame.views.empty()) {
    const auto begin = std::chrono::steady_clock::now();
    find(frame, solution);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
    solution.seconds = elapsed.count();
  }
  solution.state = smoothed(solution);
  return solution;
}

void Tracker::find(const Frame& frame, Solution& solution) {
  if (job_.valid()) return wait_for_job(frame, solution);
  Candidate best = found_any_ ? follow(frame) : begin(frame);
  if (recovers() && judge_.experienced() && known(best)) {
    const bool in_background = settings_.recovery.run == RecoveryRun::background;
    if (in_background && !is_right(best)) {
      start_job(frame, best);
      return stay_lost(frame, solution);
    }
    if (!in_background && (!is_right(best) || confirmations_ > 0 || is_time_to_doubt(best)))
      recover(frame, best);
  }
  answer(frame, best, solution);
}

void Tracker::answer(const Frame& frame, const Candidate& best, Solution& solution) {
  solution.cost = best.found.cost;
  solution.evaluations = best.found.evaluations;
  solution.probability = best.verdict.probability;
  conclude(frame, best, solution);
}

void Tracker::conclude(const Frame& frame, const Candidate& best, Solution& solution) {
  const bool answered = std::isfinite(best.found.cost);
  const double visible = answered ? search_.tiles().visible_share(best.found.state) : 0;
  if (uncertainty_ && answered) {
    solution.sigma = uncertainty_->of(search_.evaluator(), best.found.state);
    solution.evaluations += uncertainty_->evaluations();
  }
  solution.status = monitor_.judge(
      {.cost = best.found.cost,
       .probability = best.verdict.probability,
       .visible = visible,
       .sigma = largest_sigma(solution.sigma),
       .on_foreground = answered ? search_.tiles().on_foreground(frame, best.found.state)
                                 : OnForeground::unknown,
       .in_view = best.in_view});
  const bool tracked = solution.status == Status::tracked;
  const bool good = tracked || solution.status == Status::uncertain;
  // Without a recovery tracking goes on from any answer that can be seen, as in the paper; so it
  // does where nothing better was ever found.
  const bool settles = !recovers() || (!judge_.experienced() && begun_ >= kPatientFrames);
  if (good || (settles && answered && visible > 0)) {
    go_on_from(best.found.state, frame);
  } else {
    keep_last(frame);
  }
  if (tracked) learn(frame, best);
  confirmations_ = !tracked ? kConfirmations : std::max(0, confirmations_ - 1);
  if (!good) predictor_.forget_motion();
  if (recovers() && !good) widen(solution.sigma, frame.time - kept_.time);
  last_status_ = solution.status;
  if (answered && !std::isnan(best.verdict.probability)) believed_ = best.verdict.models;
}

void Tracker::start_job(const Frame& frame, const Candidate& best) {
  // The source may use its images again.
  Frame copy = frame;
  for (View& view : copy.views) {
    view.color = view.color.clone();
    view.mask = view.mask.clone();
    view.depth = view.depth.clone();
  }
  job_ = std::async(std::launch::async, [this, copy = std::move(copy), from = best]() mutable {
    recover(copy, from);
    return from;
  });
}

void Tracker::wait_for_job(const Frame& frame, Solution& solution) {
  if (job_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return stay_lost(frame, solution);
  Candidate best = job_.get();
  if (!best.in_view || !(best.verdict.probability >= kHint))
    return answer(frame, best.in_view ? Candidate{} : best, solution);
  // That was an earlier frame: this one is searched from its answer.
  const std::int64_t evaluations = best.found.evaluations;
  search_.look(frame, best.found.state, false);
  best = judged(frame, settled(best.found.state, frame_seed(seed_, frame.index)));
  best.found.evaluations += evaluations;
  if (!is_right(best)) recover(frame, best, true);
  answer(frame, best, solution);
}

void Tracker::stay_lost(const Frame& frame, Solution& solution) {
  solution.status = last_status_ = monitor_.judge({.cost = kInfinite});
  state_ = extrapolated(frame.time);
  widen(solution.sigma, frame.time - kept_.time);
}

Tracker::Candidate Tracker::judged(const Frame& frame, Found found) {
  Candidate out{std::move(found), {}, true};
  if (settings_.evidence && std::isfinite(out.found.cost))
    out.verdict = judge_.judge(frame, out.found.state, search_.second_view_colors());
  // A model that others hide is as likely right as it was before.
  for (std::size_t m = 0; m < std::min(believed_.size(), out.verdict.models.size()); ++m) {
    if (!std::isnan(out.verdict.models[m]) || std::isnan(out.verdict.probability)) continue;
    out.verdict.models[m] = believed_[m];
    out.verdict.probability = std::fmin(out.verdict.probability, believed_[m]);
  }
  return out;
}

bool Tracker::known(const Candidate& candidate) const {
  return !std::isnan(candidate.verdict.probability) || !std::isfinite(candidate.found.cost);
}

bool Tracker::is_time_to_doubt(const Candidate& best) {
  constexpr int kEvery = 4;  // doubtful frames
  if (best.verdict.probability >= settings_.surely_above) return false;
  return ++doubts_ % kEvery == 1;
}

bool Tracker::is_right(const Candidate& candidate) const {
  return candidate.verdict.probability >= monitor_.needed();
}

Tracker::Candidate Tracker::follow(const Frame& frame) {
  const bool lost = last_status_ == Status::lost || last_status_ == Status::absent;
  if (recovers() && judge_.experienced() && lost) return {};
  const Eigen::MatrixXd starts = possible_starts(frame.time);
  Budget budget = budget_;
  budget.usual_cost = monitor_.usual_cost();
  search_.look(frame, starts.col(0), !found_any_);
  const Eigen::VectorXd prior = search_.cheapest(starts);
  const std::int64_t compared = starts.cols() > 1 ? starts.cols() : 0;
  budget.evaluations -= compared;
  std::optional<Reach> reach;
  if (recovers()) reach = reach_within(settings_.motion, frame.time - time_);
  Found found = search_.from(prior, budget, reach, frame_seed(seed_, frame.index));
  found.evaluations += compared;
  return judged(frame, std::move(found));
}

Tracker::Candidate Tracker::begin(const Frame& frame) {
  const std::uint64_t seed = frame_seed(seed_, frame.index);
  const int count = recovers() && begun_ < kPatientFrames ? settings_.recovery.first_starts : 1;
  ++begun_;
  std::vector<Candidate> candidates;
  std::int64_t evaluations = 0;
  for (int k = 0; k < count; ++k) {
    // Off by as much as a start by hand is, in another direction each.
    const Displacement off{0.025, 20 * kDegree, 0};
    const Eigen::VectorXd start =
        k == 0 ? first_ : displaced(scene_, first_, off, seed_of_part(seed_, 100 + k));
    if (k > 0 && search_.tiles().visible_share(start) == 0) continue;
    search_.forget_colors();
    candidates.push_back(judged(
        frame, search_.from_guess(frame, start, budget_, k == 0 ? seed : seed_of_part(seed, k))));
    evaluations += candidates.back().found.evaluations;
    if (!known(candidates.back())) break;
  }
  Candidate best = candidates.size() == 1 ? candidates[0] : best_of(frame, candidates);
  best.found.evaluations = evaluations;
  return best;
}

Tracker::Candidate Tracker::best_of(const Frame& frame, const std::vector<Candidate>& candidates) {
  const auto most = std::ranges::max_element(candidates, {}, [](const Candidate& c) {
    return std::isnan(c.verdict.probability) ? -1.0 : c.verdict.probability;
  });
  if (search_.tiles().visible_share(most->found.state) == 0) return *most;
  look_at(frame, most->found.state);
  // Costs compare in one tile only.
  Eigen::MatrixXd states(scene_.dimension(), static_cast<Eigen::Index>(candidates.size()));
  for (std::size_t i = 0; i < candidates.size(); ++i)
    states.col(static_cast<Eigen::Index>(i)) = candidates[i].found.state;
  Eigen::VectorXd costs(states.cols());
  search_.evaluator().evaluate(states, costs);
  auto best = static_cast<std::size_t>(most - candidates.begin());
  const double enough = std::min(most->verdict.probability - kAlike, settings_.tracked_above);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (candidates[i].verdict.probability >= std::max(enough, 0.5 * most->verdict.probability) &&
        costs[static_cast<Eigen::Index>(i)] < costs[static_cast<Eigen::Index>(best)])
      best = i;
  Candidate out = candidates[best];
  if (&candidates[best] != &*most) look_at(frame, out.found.state);
  out.found.cost = costs[static_cast<Eigen::Index>(best)];
  return out;
}

void Tracker::look_at(const Frame& frame, const Eigen::VectorXd& state) {
  if (!judge_.experienced()) {
    // Whatever was learned from another start is wrong here.
    search_.forget_colors();
    search_.look(frame, state, true);
  }
  search_.look(frame, state, false);
}

Found Tracker::settled(const Eigen::VectorXd& start, std::uint64_t seed) {
  constexpr int kMost = 4;
  constexpr double kGain = 0.02;  // of the cost that is worth another search
  Found found{start, std::numeric_limits<double>::infinity(), 0};
  for (int k = 0; k < kMost; ++k) {
    Found next = search_.from(found.state, budget_, std::nullopt,
                              seed_of_part(seed, static_cast<std::uint32_t>(k)));
    next.evaluations += found.evaluations;
    const bool settles = !(found.cost - next.cost > kGain * std::abs(next.cost));
    found = std::move(next);
    if (settles && k > 0) break;
  }
  return found;
}

void Tracker::recover(const Frame& frame, Candidate& best, bool near_only) {
  const std::uint64_t seed = seed_of_part(frame_seed(seed_, frame.index), 7);
  LastKnown last{kept_.state, std::max(frame.time - kept_.time, 1e-3)};
  std::vector<bool> lost(scene_.items().size(), true);
  for (std::size_t m = 0; m < best.verdict.models.size(); ++m) {
    const double p = best.verdict.models[m];
    lost[m] = !(p >= monitor_.needed()) && !std::isnan(p);
    const Scene::Item& item = scene_.items()[m];
    const Eigen::Index size = item.model->dimension();
    if (!lost[m])
      last.state.segment(item.offset, size) = best.found.state.segment(item.offset, size);
  }
  if (near_only || best.verdict.probability >= kHint) last.hint = best.found.state;
  last.near_hint_only = near_only;
  if (std::ranges::none_of(lost, [](bool is) { return is; })) lost.assign(lost.size(), true);
  const Candidates candidates =
      recovery_.find(search_, frame, judge_, last, lost, settings_.motion, seed);
  std::int64_t evaluations = best.found.evaluations + candidates.evaluations;
  best.in_view = candidates.in_view;
  const Reach reach = reach_within(settings_.motion, last.seconds);
  std::vector<Candidate> all;
  if (std::isfinite(best.found.cost)) all.push_back(best);
  std::uint32_t k = 0;
  for (const Eigen::VectorXd& state : candidates.states) {
    if (search_.tiles().visible_share(state) == 0) continue;
    search_.look(frame, state, false);
    Candidate one = judged(frame, settled(state, seed_of_part(seed, ++k)));
    evaluations += one.found.evaluations;
    if (is_within(scene_, reach, kept_.state, one.found.state)) all.push_back(std::move(one));
  }
  if (!all.empty()) {
    const bool in_view = best.in_view;
    best = best_of(frame, all);
    best.in_view = in_view || is_right(best);
  }
  best.found.evaluations = evaluations;
}

void Tracker::learn(const Frame& frame, const Candidate& best) {
  if (settings_.evidence && !std::isnan(best.verdict.probability) && is_time_to_learn()) {
    if (!judge_.judged(best.found.state))
      judge_.judge(frame, best.found.state, search_.second_view_colors());
    judge_.learn();
  }
  ++learned_;
  search_.learn(frame, best.found.state);
  recovery_.remember(best.found.state);
  kept_ = {best.found.state, frame.time, predictor_.velocity()};
}

bool Tracker::is_time_to_learn() const {
  constexpr int kAtFirst = 10, kEvery = 4;  // frames
  return learned_ < kAtFirst || learned_ % kEvery == 0;
}

Eigen::MatrixXd Tracker::possible_starts(double time) {
  const Eigen::MatrixXd states = predictor_.at(time);
  // Tiles can be cut around what is seen only.
  if (states.cols() == 0 || search_.tiles().visible_share(states.col(0)) == 0) return state_;
  return states.cols() < budget_.evaluations ? states : states.leftCols(1);
}

void Tracker::go_on_from(const Eigen::VectorXd& found, const Frame& frame) {
  state_ = found;
  time_ = frame.time;
  found_any_ = true;
  predictor_.add(state_, frame.time);
}

void Tracker::keep_last(const Frame& frame) {
  if (!recovers()) return;
  const Eigen::VectorXd led = extrapolated(frame.time);
  state_ = search_.tiles().visible_share(led) > 0 ? led : kept_.state;
  time_ = kept_.time;
}

Eigen::VectorXd Tracker::extrapolated(double time) const {
  constexpr double kSlowing = 0.1;  // seconds in which motion that nobody sees dies away
  if (!kept_.velocity) return kept_.state;
  const double seconds = kSlowing * (1 - std::exp(-std::max(time - kept_.time, 0.0) / kSlowing));
  return moved(scene_, kept_.state, *kept_.velocity * seconds);
}

void Tracker::widen(Eigen::VectorXd& sigma, double seconds) const {
  const double spread = spread_after(seconds);
  for (double& s : sigma)
    if (!(s > spread)) s = spread;
}

Eigen::VectorXd Tracker::smoothed(const Solution& solution) {
  if (!smoothing_) return state_;
  if (solution.status == Status::lost || solution.status == Status::absent) smoother_.begin_anew();
  if (solution.status != Status::missing) output_ = smoother_.filter(state_, solution.time);
  return output_;
}

double Tracker::largest_sigma(const Eigen::VectorXd& sigma) const {
  if (sigma.size() == 0) return kUnknown;
  return std::ranges::max(model_means(landmarks_, sigma));
}

void Tracker::check(const Frame& frame) {
  search_.take_in(search_.tiles(), frame, search_.tiles().plan(frame, state_));
}

std::string Tracker::problem_of_start(const Frame& frame) const {
  constexpr const char* kQuestion =
      "is the start (init) where the models are, and do the cameras and their units (calibration) "
      "belong to the pictures?";
  const double visible = search_.tiles().visible_share(state_);
  if (visible < settings_.min_visible)
    return fmt::format(
        "{:.0f} % of what the models cover at the start is inside every image, and a frame with "
        "less than {:.0f} % counts as lost (tracker.min_visible); {}",
        100 * visible, 100 * settings_.min_visible, kQuestion);
  const OnForeground on_foreground = search_.tiles().on_foreground(frame, state_);
  if (on_foreground == OnForeground::nowhere)
    return fmt::format(
        "the models at the start cover no foreground pixel of any mask, and such a frame counts as "
        "lost; {}",
        kQuestion);
  if (on_foreground == OnForeground::in_parts)
    return fmt::format(
        "no point of the models at the start is on the foreground of all masks, and such a frame "
        "counts as uncertain; {}",
        kQuestion);
  return {};
}

}  // namespace hypotrack
