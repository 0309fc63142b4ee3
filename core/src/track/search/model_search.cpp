#include "track/search/model_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "base/profile.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "hypotrack/plugin/search.hpp"
#include "track/recover/held_models.hpp"
#include "track/sighting.hpp"

namespace hypotrack::internal {
namespace {

// Longest time since a model was surely right, in seconds, at which two agreeing poses end the
// search. Later they may both be wrong.
constexpr double kRecent = 0.15;
// Places that are searched although a starter that detects the model sees it nowhere.
constexpr std::size_t kDeniedPlaces = 2;
// Effort of searches for a known model after a starter that detects it, as a share of the usual
// one: it says where the model is, or later frames search again.
constexpr double kToldShare = 0.2;
constexpr std::size_t kAllPlaces = std::numeric_limits<std::size_t>::max();

/// Lends a tracker's global search to its starters.
class LentSearch final : public GlobalSearch {
 public:
  using Search = std::function<void(const GlobalSearchSettings&, const TakePose&)>;
  explicit LentSearch(Search search) : search_(std::move(search)) {}
  void find(const GlobalSearchSettings& settings, const TakePose& take) override {
    search_(settings, take);
  }

 private:
  Search search_;
};

/// Returns settings whose zeros are replaced by those of recoveries.
GlobalSearchSettings with_defaults(GlobalSearchSettings settings, const RecoverySettings& usual) {
  if (settings.hypotheses == 0) settings.hypotheses = usual.hypotheses;
  if (settings.refined == 0) settings.refined = usual.refined;
  if (settings.searched == 0) settings.searched = usual.searched;
  return settings;
}

}  // namespace

CandidateFinder::ModelSearch::ModelSearch(CandidateFinder& finder, const Frame& frame,
                                          const RecoveryRequest& request, const Candidate& base,
                                          Candidate& best, std::size_t model,
                                          const ModelFlags& held, std::uint64_t seed)
    : finder_(finder),
      frame_(frame),
      request_(request),
      base_(base),
      best_(best),
      item_(finder.scene_.items()[model]),
      model_(model),
      has_held_(any(held)),
      seed_(seed),
      shown_(base.shown),
      moving_(base.shown.size(), false),
      task_(finder.recovery_.begin(finder.search_, frame, finder.verifier_, last_known(), model,
                                   base.shown, held)) {
  best.in_view[model] = task_.in_view;
  shown_[model] = moving_[model] = true;
  for (std::size_t m = 0; m < held.size(); ++m)
    if (held[m]) shown_[m] = moving_[m] = true;
  is_followed_ = best.answers() && best.shown[model];
  if (is_followed_ && shown_ == best.shown) found_.push_back(best);
}

Eigen::VectorXd CandidateFinder::ModelSearch::with_own_part(Eigen::VectorXd to,
                                                            const Eigen::VectorXd& from) const {
  const Eigen::Index size = item_.model->dimension();
  to.segment(item_.offset, size) = from.segment(item_.offset, size);
  return to;
}

LastKnown CandidateFinder::ModelSearch::last_known() const {
  const Eigen::VectorXd& others = base_.answers() ? base_.found.state : request_.kept;
  LastKnown last{with_own_part(others, request_.kept), request_.seconds[model_]};
  if (best_.answers() && best_.shown[model_] && best_.probabilities[model_] >= kLeastPromising)
    last.hint = with_own_part(last.state, best_.found.state);
  last.near_hint_only = request_.near_only;
  last.before = request_.together;
  return last;
}

bool CandidateFinder::ModelSearch::enough() const {
  const bool is_recent = request_.seconds[model_] < kRecent;
  return sure_ || (is_recent && finder_.has_confirmed(found_, model_));
}

void CandidateFinder::ModelSearch::improve_limbs(Candidate& one) {
  FrameSearch& search = finder_.search_;
  if (search.tiles().visible_share(one.found.state) == 0) return;
  const auto better = finder_.recovery_.search(model_).with_better_limbs(
      search.cost(), search.drawn(one.found.state), moving_, one.found.evaluations);
  if (!better) return;
  for (std::size_t m = 0; m < moving_.size(); ++m) {
    if (!moving_[m]) continue;
    const Scene::Item& item = finder_.scene_.items()[m];
    const Eigen::Index size = item.model->dimension();
    one.found.state.segment(item.offset, size) = better->segment(item.offset, size);
  }
  one = finder_.go_on(frame_, one, seed_of_part(seed_, part_++));
}

void CandidateFinder::ModelSearch::put_back(Candidate& one) {
  constexpr double kMoved = 0.003;  // metres, of any landmark: a search evens out less
  const Scene& scene = finder_.scene_;
  Eigen::VectorXd state = one.found.state;
  for (const HeldModel& held : task_.held) {
    const Eigen::VectorXd kept =
        moved_with(scene, held.model, model_, request_.together, one.found.state);
    const Scene::Item& item = scene.items()[held.model];
    const Eigen::Index size = item.model->dimension();
    state.segment(item.offset, size) = kept.segment(item.offset, size);
  }
  const Eigen::Matrix3Xd motion = scene.landmarks(state) - scene.landmarks(one.found.state);
  if (!(motion.colwise().norm().maxCoeff() > kMoved)) return;
  if (finder_.search_.tiles().visible_share(state) == 0) return;
  Candidate back = one;
  back.found.state = std::move(state);
  back = finder_.go_on(frame_, back, seed_of_part(seed_, part_++));
  const std::int64_t evaluations = back.found.evaluations;
  one = finder_.best_of(frame_, {std::move(one), std::move(back)});
  one.found.evaluations = evaluations;
}

void CandidateFinder::ModelSearch::add(const Eigen::VectorXd& state) {
  FrameSearch& search = finder_.search_;
  search.show(shown_, moving_);
  if (search.tiles().visible_share(state) == 0) return;
  Candidate one = finder_.searched_from(frame_, state, seed_of_part(seed_, part_++));
  if (!std::isfinite(task_.last.seconds)) improve_limbs(one);
  const Eigen::VectorXd turned = finder_.verifier_.model(model_).turned_to_texture(
      frame_, one.found.state, search.second_view_colors());
  if (turned != one.found.state) {
    one.found.state = turned;
    one = finder_.go_on(frame_, one, seed_of_part(seed_, part_++));
  }
  if (has_held_) put_back(one);
  best_.found.evaluations += std::exchange(one.found.evaluations, 0);
  const Reach reach = reach_within(finder_.settings_.motion, task_.last.seconds);
  const bool may_be_anywhere = !std::isfinite(task_.last.seconds) || request_.contradicts;
  if (!may_be_anywhere && !is_within(finder_.scene_, reach, request_.kept,
                                     with_own_part(request_.kept, one.found.state)))
    return;
  if (finder_.is_of_another(model_, one.found.state)) return;
  sure_ = sure_ || one.is_sure();
  found_.push_back(std::move(one));
}

template <class Take>
void CandidateFinder::ModelSearch::search_places(const GlobalSearchSettings& effort,
                                                 std::size_t most, const Take& take) {
  finder_.recovery_.look(task_, finder_.settings_.motion);
  best_.in_view[model_] = task_.in_view;
  for (const PoseGuess& guess : task_.guesses) {
    if (enough() || most-- == 0) return;
    const Candidates places = finder_.recovery_.find(task_, guess, effort, finder_.settings_.motion,
                                                     seed_of_part(seed_, part_++));
    best_.found.evaluations += places.evaluations;
    for (const Eigen::VectorXd& state : places.states) {
      if (enough()) return;
      take(state);
    }
  }
}

double CandidateFinder::ModelSearch::distance(const Eigen::VectorXd& a,
                                              const Eigen::VectorXd& b) const {
  return finder_.distance(model_, a, b);
}

double CandidateFinder::ModelSearch::unseen(const Eigen::VectorXd& state) const {
  const auto is_here = [&](const Eigen::VectorXd& other) { return distance(other, state) < kHere; };
  if (std::ranges::any_of(detected_, is_here)) return 0;
  if (is_followed_ && is_here(best_.found.state)) return request_.unseen[model_];
  return std::numeric_limits<double>::infinity();
}

bool CandidateFinder::ModelSearch::is_known(const Eigen::VectorXd& state) const {
  if (request_.contradicts) return distance(state, best_.found.state) <= kElsewhere;
  return is_followed_ && !request_.thorough[model_] && distance(state, best_.found.state) < kHere;
}

CandidateFinder::ModelSearch::Proposals CandidateFinder::ModelSearch::ask(Starter& starter,
                                                                          bool denied,
                                                                          bool may_search) {
  const ProfiledPart part("ask a starter");
  LentSearch lent([&](GlobalSearchSettings effort, const TakePose& offer) {
    // Where a starter sees the model, its pose is about known; where one denies it, it hardly is
    // there.
    const bool told = denied || !detected_.empty();
    if (told) effort = with_defaults(effort, finder_.settings_.recovery);
    if (told && std::isfinite(task_.last.seconds)) effort = share_of(effort, kToldShare);
    const std::size_t most = denied ? kDeniedPlaces : kAllPlaces;
    search_places(effort, most, [&](const Eigen::VectorXd& state) {
      offer(state.segment(item_.offset, item_.model->dimension()));
    });
  });
  const bool searches = !request_.contradicts && may_search;
  const StarterContext context{finder_.scene_, finder_.cameras_, &frame_,
                               searches ? &lent : nullptr, request_.contradicts};
  Proposals out;
  starter.find(context, model_, [&](const Eigen::VectorXd& parameters) {
    check_proposal(item_, parameters);
    Eigen::VectorXd state = task_.last.state;
    state.segment(item_.offset, parameters.size()) = parameters;
    const bool is_new = !is_known(state);
    if (is_new) add(state);
    if (starter.detects(model_)) detected_.push_back(state);
    (is_new ? out.taken : out.known).push_back(std::move(state));
    return !enough();
  });
  return out;
}

void CandidateFinder::ModelSearch::search_only_near(const std::vector<Eigen::VectorXd>& states) {
  constexpr std::size_t kMost = 2;
  constexpr double kNearShare = 0.5, kTurn = 0.5, kScatter = 0.015;  // radians, metres
  task_.guesses.clear();
  task_.looked = true;
  for (std::size_t i = 0; i < std::min(kMost, states.size()); ++i)
    task_.guesses.push_back(
        {.center =
             posed_landmarks(*item_.model, finder_.scene_.part(item_, states[i])).rowwise().mean(),
         .pose = states[i].segment(item_.offset, item_.model->dimension()),
         .near_share = kNearShare,
         .rotation = kTurn,
         .scatter = kScatter,
         .centred = true});
}

void CandidateFinder::ModelSearch::ask_starters() {
  const auto is_good = [&](const Candidate& one) {
    return one.probability() >= finder_.settings_.thresholds.certain_above;
  };
  const bool never_seen = !std::isfinite(request_.seconds[model_]);
  // Where several models are denied at once, none of them is shown yet.
  if (found_.empty() && is_followed_ && request_.unseen[model_] <= kRemembered)
    add(with_own_part(task_.last.state, best_.found.state));
  bool asked = false;   // a starter that detects the model, this one or before
  bool denied = false;  // by such a starter
  for (const std::unique_ptr<Starter>& starter : finder_.starters_) {
    const bool is_first = starter == finder_.starters_.front();
    if (enough() || (!is_first && std::ranges::any_of(found_, is_good))) break;
    const bool detects = starter->detects(model_);
    asked = asked || detects;
    const Proposals proposed = ask(*starter, denied, !asked || request_.thorough[model_]);
    if (!detects) continue;
    denied = denied || (proposed.taken.empty() && proposed.known.empty());
    if (!request_.contradicts && !proposed.known.empty()) break;
    if (!request_.contradicts && !proposed.taken.empty()) search_only_near(proposed.taken);
    if (request_.contradicts && !proposed.taken.empty() && proposed.known.empty())
      finder_.contradicted_ = true;
  }
  // Nothing was learned yet by which the model could be told from other things.
  if (denied && never_seen && !(request_.unseen[model_] <= kRemembered))
    std::erase_if(found_, [&](const Candidate& one) { return !is_good(one); });
}

void CandidateFinder::ModelSearch::run() {
  if (finder_.starters_.empty() || has_held_ || request_.near_only)
    search_places(request_.effort, kAllPlaces, [&](const Eigen::VectorXd& state) { add(state); });
  else
    ask_starters();
}

}  // namespace hypotrack::internal
