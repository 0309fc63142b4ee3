#include "track/search/candidate_finder.hpp"

#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/profile.hpp"
#include "hypotrack/plugin/search.hpp"
#include "track/search/displace.hpp"
#include "track/search/model_search.hpp"

namespace hypotrack::internal {
namespace {

// Ratio of odds below which candidates count as equally probable; their costs decide then.
constexpr double kAlike = 2.3;
// Distance, in metres, up to which the centres of two models are at the same place: two models
// of a scene can hardly be nearer.
constexpr double kSamePlace = 0.05;
// Time constant, in seconds, with which the belief in a hidden model decays.
constexpr double kForgotten = 0.6;

/// Returns the least probability that counts as equal to the given highest one.
double as_likely(double highest) {
  constexpr double kMost = 0.98;  // higher probabilities are not told apart
  const double p = std::min(highest, kMost);
  const double odds = p / (1 - p) / kAlike;
  return odds / (1 + odds);
}

}  // namespace

double Candidate::probability() const {
  double least = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t m = 0; m < probabilities.size(); ++m)
    if (shown[m]) least = std::fmin(least, probabilities[m]);  // fmin ignores NaN
  return least;
}

void Candidate::drop(std::size_t model) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  shown[model] = false;
  probabilities[model] = 0;
  unseen[model] = kInfinite;
  if (!any(shown)) found.cost = kInfinite;
}

CandidateFinder::CandidateFinder(const Scene& scene, TrackerParts& parts,
                                 const StatusSettings& settings)
    : scene_(scene),
      cameras_(parts.cameras),
      settings_(settings),
      starters_(std::move(parts.starters)),
      budget_(parts.budget),
      search_(scene, parts),
      verifier_(scene, parts.cameras, parts.judge),
      occlusion_(scene, parts.cameras),
      recovery_(scene, parts.cameras, parts.status.recovery),
      believed_(scene.items().size(), std::numeric_limits<double>::quiet_NaN()) {
  if (budget_.evaluations == 0) budget_.evaluations = search_.default_evaluations();
}

Candidate CandidateFinder::verified(const Frame& frame, Found found) {
  const ProfiledPart part("measure");
  const ReadyThreads::Awake awake(ready_threads());
  const std::size_t models = scene_.items().size();
  Candidate out{std::move(found),
                ModelProbabilities(models, std::numeric_limits<double>::quiet_NaN()),
                search_.shown(),
                ModelFlags(models, true),
                ModelFlags(models, false),
                ModelFlags(models, false),
                std::vector<double>(models, std::numeric_limits<double>::infinity())};
  if (settings_.judged && out.answers())
    out.probabilities = verifier_.verify(frame, search_.drawn(out.found.state),
                                         search_.second_view_colors(), out.shown);
  if (std::isnan(out.probability())) return out;
  // A hidden model keeps its last probability, which decays with time.
  const double left = std::exp(-std::max(frame.time - believed_time_, 0.0) / kForgotten);
  for (std::size_t m = 0; m < models; ++m)
    if (out.shown[m] && std::isnan(out.probabilities[m]))
      out.probabilities[m] = left * believed_[m];
  return out;
}

Candidate CandidateFinder::begin(const Frame& frame, const Eigen::VectorXd& start, int count,
                                 std::uint64_t seed) {
  std::vector<Candidate> candidates;
  std::int64_t evaluations = 0;
  for (int k = 0; k < count; ++k) {
    const auto part = static_cast<std::uint32_t>(k);
    // Typical error of a start that a person sets, in a different direction each time.
    const Displacement off{0.025, 20 * kDegree, 0};
    const Eigen::VectorXd from =
        k == 0 ? start : displaced(scene_, start, off, seed_of_part(seed, 100 + part));
    if (k > 0 && search_.tiles().visible_share(from) == 0) continue;
    search_.forget_colors();
    candidates.push_back(verified(
        frame, search_.from_guess(frame, from, budget_, k == 0 ? seed : seed_of_part(seed, part))));
    evaluations += candidates.back().found.evaluations;
    if (std::isnan(candidates.back().probability())) break;
  }
  Candidate best = candidates.size() == 1 ? candidates[0] : best_of(frame, candidates);
  for (std::size_t m = 0; m < best.confirmed.size(); ++m) {
    best.confirmed[m] = is_confirmed(candidates, best, m);
    best.reproduced[m] = is_reproduced(candidates, best, m);
  }
  best.found.evaluations = evaluations;
  best.from_start = true;
  return best;
}

bool CandidateFinder::begin_again(const Frame& frame, const Eigen::VectorXd& start, int count,
                                  std::uint64_t seed, Candidate& best) {
  search_.show(ModelFlags(scene_.items().size(), true));
  Candidate again = begin(frame, start, count, seed);
  again.found.evaluations += best.found.evaluations;
  const bool is_better = search_.tiles().visible_share(best.found.state) == 0 ||
                         again.probability() > best.probability();
  if (is_better) {
    best = std::move(again);
  } else {
    best.found.evaluations = again.found.evaluations;
    look_at(frame, best.found.state);
  }
  return is_better;
}

Candidate CandidateFinder::follow(const Frame& frame, const Eigen::MatrixXd& starts,
                                  const ModelFlags& models, const Budget& budget,
                                  const std::optional<Reach>& reach, std::uint64_t seed) {
  constexpr double kLess = 0.15, kNewest = 0.3;
  constexpr double kLikely = 0.6;  // no pose becomes hidden that was not right before
  search_.show(models);
  const bool was_hidden = occlusion_.is_awaited();
  if (was_hidden) look_for_occluders(frame, search_.drawn(starts.col(0)), models);
  Candidate out = searched(frame, starts, budget, reach, seed);
  const double probability = out.probability();
  const bool is_worse = usual_probability_ >= kLikely && probability < usual_probability_ - kLess;
  if (!std::isnan(probability)) usual_probability_ += kNewest * (probability - usual_probability_);
  if (was_hidden || !is_worse) return out;
  if (!look_for_occluders(frame, search_.drawn(starts.col(0)), models)) return out;
  Candidate again = searched(frame, starts, budget, reach, seed);
  again.found.evaluations += out.found.evaluations;
  return again;
}

bool CandidateFinder::look_for_occluders(const Frame& frame, const Eigen::VectorXd& state,
                                         const ModelFlags& models) {
  const bool was_hidden = occlusion_.hidden() != nullptr;
  occlusion_.look(frame, state, search_.second_view_colors(), verifier_, models);
  search_.hide(occlusion_.hidden());
  verifier_.hide(occlusion_.hidden());
  return was_hidden || occlusion_.hidden();
}

std::vector<bool> CandidateFinder::hidden(const Eigen::VectorXd& state) const {
  if (!occlusion_.hidden()) return {};
  std::vector<bool> out = occlusion_.hidden()->covers(scene_.landmarks(state));
  if (!any(out)) out.clear();
  return out;
}

Candidate CandidateFinder::searched(const Frame& frame, const Eigen::MatrixXd& starts,
                                    const Budget& budget, const std::optional<Reach>& reach,
                                    std::uint64_t seed) {
  search_.look(frame, starts.col(0), false);
  const Recovery::Reduction reduction(recovery_, is_time_to_learn() ? &frame : nullptr);
  const Eigen::VectorXd prior = search_.cheapest(starts);
  Budget left = budget;
  const std::int64_t compared = starts.cols() > 1 ? starts.cols() : 0;
  left.evaluations -= compared;
  Found found = search_.from(prior, left, reach, seed);
  found.evaluations += compared;
  return verified(frame, std::move(found));
}

ReadyThreads* CandidateFinder::ready_threads() {
  constexpr int kOneIn = 4, kMost = 3;  // threads of the arena
  const int count = std::min(kMost, oneapi::tbb::this_task_arena::max_concurrency() / kOneIn);
  if (!settings_.judged || !search_.is_on_gpu() || count == 0) return nullptr;
  if (!ready_) ready_ = std::make_unique<ReadyThreads>(count);
  return ready_.get();
}

Candidate CandidateFinder::go_on(const Frame& frame, const Candidate& from, std::uint64_t seed) {
  search_.show(from.shown);
  search_.look(frame, from.found.state, false);
  Candidate out = verified(frame, search_.settled(from.found.state, budget_, seed));
  out.found.evaluations += from.found.evaluations;
  out.unseen = from.unseen;
  return out;
}

Candidate CandidateFinder::best_of(const Frame& frame, const std::vector<Candidate>& candidates,
                                   const std::vector<double>& apart) {
  constexpr double kSimilar = 0.05;  // of the cost
  const auto most = std::ranges::max_element(candidates, {}, [](const Candidate& c) {
    const double p = c.probability();
    return std::isnan(p) ? -1.0 : p;
  });
  if (search_.tiles().visible_share(most->found.state) == 0) return *most;
  look_at(frame, most->found.state);
  // Costs are comparable within one tile only.
  Eigen::MatrixXd states(scene_.dimension(), static_cast<Eigen::Index>(candidates.size()));
  for (std::size_t i = 0; i < candidates.size(); ++i)
    states.col(static_cast<Eigen::Index>(i)) = candidates[i].found.state;
  const Eigen::VectorXd costs = search_.costs(states);
  auto best = static_cast<std::size_t>(most - candidates.begin());
  const double highest = most->probability();
  const double enough = as_likely(highest);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (candidates[i].probability() >= enough &&
        costs[static_cast<Eigen::Index>(i)] < costs[static_cast<Eigen::Index>(best)])
      best = i;
  // A box turned by 180 degrees looks the same: prefer the pose closest to the last one, moved
  // with the model that holds the box.
  const double cheapest = costs[static_cast<Eigen::Index>(best)];
  const double similar = cheapest + kSimilar * std::abs(cheapest);
  for (std::size_t i = 0; i < apart.size(); ++i)
    if (candidates[i].probability() >= enough && costs[static_cast<Eigen::Index>(i)] <= similar &&
        apart[i] < apart[best])
      best = i;
  Candidate out = candidates[best];
  if (&candidates[best] != &*most) look_at(frame, out.found.state);
  out.found.cost = costs[static_cast<Eigen::Index>(best)];
  return out;
}

void CandidateFinder::look_at(const Frame& frame, const Eigen::VectorXd& state) {
  if (!verifier_.experienced()) {
    // Colours learned from another start are wrong here.
    search_.forget_colors();
    search_.look(frame, state, true);
  }
  search_.look(frame, state, false);
}

Candidate CandidateFinder::searched_from(const Frame& frame, const Eigen::VectorXd& state,
                                         std::uint64_t seed) {
  if (verifier_.experienced()) {
    search_.look(frame, state, false);
    return verified(frame, search_.settled(state, budget_, seed));
  }
  search_.forget_colors();
  Found found = search_.from_guess(frame, state, budget_, seed);
  if (search_.tiles().visible_share(found.state) == 0) return verified(frame, std::move(found));
  look_at(frame, found.state);
  Found better = search_.settled(found.state, budget_, seed_of_part(seed, 2));
  better.evaluations += found.evaluations;
  return verified(frame, std::move(better));
}

std::optional<Candidate> CandidateFinder::with_model(const Frame& frame,
                                                     const RecoveryRequest& request,
                                                     const Candidate& base, Candidate& best,
                                                     std::size_t model, const ModelFlags& held,
                                                     std::uint64_t seed) {
  ModelSearch search(*this, frame, request, base, best, model, held, seed);
  search.run();
  search_.show(search.shown());
  const std::vector<Candidate>& all = search.found();
  if (all.empty()) return std::nullopt;
  std::vector<double> apart;
  if (request.together.size() > 0)
    for (const Candidate& one : all)
      apart.push_back(moved_while_held(scene_, request.together, one.found.state, search.shown()));
  Candidate chosen = best_of(frame, all, apart);
  chosen.confirmed = base.confirmed;
  chosen.reproduced = base.reproduced;
  chosen.from_start = base.from_start;
  chosen.unseen = base.unseen;
  chosen.unseen[model] = search.unseen(chosen.found.state);
  for (std::size_t m = 0; m < search.moving().size(); ++m)
    if (search.moving()[m]) chosen.confirmed[m] = is_confirmed(all, chosen, m);
  return chosen;
}

bool CandidateFinder::is_reproduced(const std::vector<Candidate>& all, const Candidate& chosen,
                                    std::size_t model) const {
  constexpr double kAbout = 0.01;       // metres
  constexpr std::ptrdiff_t kOneIn = 3;  // two of eight agree from a wrong posture, too
  const auto is_about_there = [&](const Candidate& one) {
    return distance(model, one.found.state, chosen.found.state) < kAbout;
  };
  return all.size() > 1 && kOneIn * std::ranges::count_if(all, is_about_there) >= std::ssize(all);
}

bool CandidateFinder::is_confirmed(const std::vector<Candidate>& all, const Candidate& chosen,
                                   std::size_t model) const {
  const auto same = [&](const Candidate& one) { return is_same(one, chosen, model); };
  return std::ranges::count_if(all, same) > 1;  // the chosen one itself counts once
}

bool CandidateFinder::has_confirmed(const std::vector<Candidate>& all, std::size_t model) const {
  for (auto a = all.begin(); a != all.end(); ++a)
    for (auto b = all.begin(); b != a; ++b)
      if (std::min(a->probabilities[model], b->probabilities[model]) >=
              settings_.thresholds.confirmed_above &&
          is_same(*a, *b, model))
        return true;
  return false;
}

bool CandidateFinder::is_same(const Candidate& a, const Candidate& b, std::size_t model) const {
  constexpr double kSame = 0.006;  // metres
  return distance(model, a.found.state, b.found.state) < kSame;
}

ModelFlags CandidateFinder::lost_with(const RecoveryRequest& request, const Candidate& base,
                                      std::size_t model) const {
  if (request.together.size() == 0) return ModelFlags(scene_.items().size(), false);
  ModelFlags out = held_by(scene_, model, request.together);
  for (std::size_t m = 0; m < out.size(); ++m)
    out[m] = out[m] && request.sought[m] && !base.shown[m] && !request.near_only;
  return out;
}

bool CandidateFinder::may_join(const Candidate& with, const Candidate& base,
                               const RecoveryRequest& request, std::size_t model) const {
  if (!with.may_be_right(model, settings_.thresholds.uncertain_above)) return false;
  for (std::size_t m = 0; m < base.shown.size(); ++m) {
    if (!base.shown[m] || m == model || std::isnan(base.probabilities[m])) continue;
    if (!(with.probabilities[m] >= std::min(request.needed[m], base.probabilities[m])))
      return false;
  }
  return true;
}

bool CandidateFinder::is_of_another(std::size_t model, const Eigen::VectorXd& state) const {
  if (sightings_.empty() || !sightings_[model].asked) return false;
  const Eigen::Vector3d here = recovery_.search(model).center(state);
  const auto is_seen = [&](std::size_t other) {
    const Scene::Item& item = scene_.items()[other];
    return std::ranges::any_of(sightings_[other].poses, [&](const Eigen::VectorXd& pose) {
      return (landmark_center(*item.model, pose) - here).norm() < kSamePlace;
    });
  };
  if (is_seen(model)) return false;
  for (std::size_t m = 0; m < sightings_.size(); ++m)
    if (m != model && is_seen(m)) return true;
  return false;
}

bool CandidateFinder::is_same_place(const Candidate& a, std::size_t of_a, const Candidate& b,
                                    std::size_t of_b) const {
  return (recovery_.search(of_a).center(a.found.state) -
          recovery_.search(of_b).center(b.found.state))
             .norm() < kSamePlace;
}

std::size_t CandidateFinder::best_option(const std::vector<std::optional<Candidate>>& options,
                                         const RecoveryRequest& request) const {
  std::size_t best = 0;
  const auto probability = [&](std::size_t m) {
    return options[m] && options[m]->probabilities[m] >= 0 ? options[m]->probabilities[m] : -1;
  };
  const auto moved = [&](std::size_t m) {
    return (recovery_.search(m).center(options[m]->found.state) -
            recovery_.search(m).center(request.kept))
        .norm();
  };
  for (std::size_t m = 1; m < options.size(); ++m)
    if (probability(m) > probability(best) || !options[best]) best = m;
  const std::size_t likeliest = best;
  if (!options[likeliest] || !std::isfinite(request.seconds[likeliest])) return likeliest;
  for (std::size_t m = 0; m < options.size(); ++m)
    if (m != best && options[m] && std::isfinite(request.seconds[m]) &&
        probability(m) >= as_likely(probability(likeliest)) &&
        is_same_place(*options[m], m, *options[likeliest], likeliest) && moved(m) < moved(best))
      best = m;
  return best;
}

bool CandidateFinder::detects(std::size_t model) const {
  return std::ranges::any_of(starters_, [&](const auto& one) { return one->detects(model); });
}

double CandidateFinder::distance(std::size_t model, const Eigen::VectorXd& a,
                                 const Eigen::VectorXd& b) const {
  const Scene::Item& item = scene_.items()[model];
  return landmark_distance(*item.model, scene_.part(item, a), scene_.part(item, b));
}

std::optional<double> CandidateFinder::seen_from(const Frame& frame, std::size_t model,
                                                 const Eigen::VectorXd& state) const {
  if (settings_.recovery.check == 0) return std::nullopt;
  const Scene::Item& item = scene_.items()[model];
  return sighting(starters_, scene_, cameras_, frame, model)
      .distance(*item.model, scene_.part(item, state));
}

void CandidateFinder::recover(const Frame& frame, const RecoveryRequest& request, Candidate& best,
                              std::uint64_t seed) {
  contradicted_ = false;
  sightings_.clear();
  if (occlusion_.is_awaited() && !occlusion_.has_looked_at(frame))
    look_for_occluders(frame, request.kept, ModelFlags(scene_.items().size(), true));
  if (scene_.items().size() > 1 && !request.near_only)
    for (std::size_t m = 0; m < scene_.items().size(); ++m)
      sightings_.push_back(sighting(starters_, scene_, cameras_, frame, m));
  Candidate base = best;
  for (std::size_t m = 0; m < request.sought.size(); ++m)
    if (request.sought[m]) {
      base.shown[m] = false;
      if (request.lost) verifier_.set_tracked(m, false);
    }
  if (!any(base.shown)) base.found.cost = std::numeric_limits<double>::infinity();
  ModelFlags left = request.sought;
  std::uint32_t part = 0;
  while (any(left)) {
    std::vector<std::optional<Candidate>> options(left.size());
    for (std::size_t m = 0; m < left.size(); ++m) {
      if (!left[m]) continue;
      std::optional<Candidate>& one = options[m];
      const ModelFlags held = lost_with(request, base, m);
      if (any(held))
        one = with_model(frame, request, base, best, m, held, seed_of_part(seed, ++part));
      if (!one || !(one->probability() >= settings_.thresholds.uncertain_above))
        one = with_model(frame, request, base, best, m, {}, seed_of_part(seed, ++part));
    }
    const std::size_t joins = best_option(options, request);
    std::optional<Candidate>& chosen = options[joins];
    // With nothing else found, a poor candidate still reports its probability.
    if (!chosen || (any(base.shown) && !may_join(*chosen, base, request, joins))) break;
    base = std::move(*chosen);
    for (std::size_t m = 0; m < left.size(); ++m)
      if (base.shown[m]) left[m] = false;
    if (!base.may_be_right(joins, settings_.thresholds.uncertain_above)) break;
  }
  base.in_view = best.in_view;
  for (std::size_t m = 0; m < base.shown.size(); ++m)
    if (base.shown[m] && base.may_be_right(m, request.needed[m])) base.in_view[m] = true;
  base.found.evaluations = best.found.evaluations;
  best = std::move(base);
  if (!best.answers()) return;
  search_.show(best.shown);
  look_at(frame, best.found.state);
}

void CandidateFinder::accept(const Frame& frame, const Candidate& best, const ModelFlags& tracked) {
  const bool is_verified = best.answers() && !std::isnan(best.probability());
  for (std::size_t m = 0; m < best.shown.size(); ++m) {
    if (is_verified && best.shown[m])
      believed_[m] = best.probabilities[m];
    else if (verifier_.experienced(m) && !(best.answers() && best.shown[m]))
      believed_[m] = 0;  // lost: it is not assumed to hide behind others
  }
  believed_time_ = frame.time;
  for (std::size_t m = 0; m < tracked.size(); ++m) verifier_.set_tracked(m, tracked[m]);
  // Do not learn from doubtful models: the tracker would follow a model that slides off.
  ModelFlags sure = tracked;
  for (std::size_t m = 0; m < sure.size(); ++m)
    if (verifier_.experienced(m) && best.probabilities[m] < settings_.thresholds.certain_above)
      sure[m] = false;
  if (any(sure) && !occlusion_.hidden()) learn(frame, best, sure);
}

bool CandidateFinder::is_time_to_learn() const {
  constexpr int kAtFirst = 10, kEvery = 4;  // frames
  return settings_.judged && (learned_ < kAtFirst || learned_ % kEvery == 0);
}

void CandidateFinder::learn(const Frame& frame, const Candidate& best, const ModelFlags& sure) {
  // Without a judge nothing is ever sought in pictures.
  const bool is_time = is_time_to_learn();
  if (is_time && !std::isnan(best.probability())) {
    const Eigen::VectorXd drawn = search_.drawn(best.found.state);
    if (!verifier_.verified(drawn))
      verifier_.verify(frame, drawn, search_.second_view_colors(), best.shown);
    verifier_.learn(sure);
  }
  ++learned_;
  search_.show(sure);
  search_.learn(frame, best.found.state);
  recovery_.remember(best.found.state, sure);
  const bool all = std::ranges::find(sure, false) == sure.end();
  if (is_time && all) recovery_.learn_backgrounds(frame, best.found.state);
}

}  // namespace hypotrack::internal
