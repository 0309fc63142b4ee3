#include "recover/recovery.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "hypotrack/search.hpp"

namespace hypotrack {
namespace {

constexpr double kWindow = 0.75;     // of a model's radius: what a place is looked for by
constexpr double kApart = 0.07;      // metres between places
constexpr double kSeen = 0.35;       // of the colours that a tracked model shows: it is in view
constexpr double kRemembered = 1.0;  // seconds for which the last place is worth a look
// Shares of hypotheses near the pose that a place is remembered with.
constexpr double kNearHint = 0.7, kNearLast = 0.8, kNearPlace = 0.25;
constexpr double kHintTurn = 0.5;     // radians
constexpr double kCovered = 0.5;      // share of a model that others may hide
constexpr int kGlance = 4;            // poses refined at a place before it is chosen
constexpr std::size_t kThorough = 2;  // places chosen
// Metres between candidates: more where models may have changed places.
constexpr double kDistinctPoses = 0.012, kDistinctModels = 0.03;
constexpr std::size_t kOfEach = 4;  // candidates of one model, to be combined with others'

/// The first of some states that are `near` metres or more apart, mean over landmarks; at most
/// `count`.
std::vector<Refined> distinct(const Scene& scene, std::vector<Refined> all, double near,
                              std::size_t count) {
  std::vector<Refined> out;
  std::vector<Eigen::Matrix3Xd> landmarks;
  for (Refined& one : all) {
    if (out.size() >= count) break;
    const Eigen::Matrix3Xd here = scene.landmarks(one.state);
    const bool known = std::ranges::any_of(landmarks, [&](const Eigen::Matrix3Xd& other) {
      return (here - other).colwise().norm().mean() < near;
    });
    if (known) continue;
    landmarks.push_back(here);
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace

std::span<const std::string_view> enum_names(RecoveryRun) {
  static constexpr std::array<std::string_view, 2> names{"frame", "background"};
  return names;
}

Recovery::Recovery(const Scene& scene, const std::vector<Camera>& cameras,
                   const RecoverySettings& settings)
    : scene_(scene), settings_(settings) {
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    searches_.push_back(std::make_unique<PoseSearch>(scene, m, cameras, settings));
    finders_.emplace_back(cameras, kWindow * searches_[m]->radius(), settings.nearest,
                          settings.farthest);
  }
}

void Recovery::remember(const Eigen::VectorXd& state) {
  for (std::size_t m = 0; m < searches_.size(); ++m) {
    const Scene::Item& item = scene_.items()[m];
    searches_[m]->postures().remember(state.segment(item.offset, item.model->dimension()));
  }
}

std::vector<PoseGuess> Recovery::guesses(std::size_t model, const Places& places,
                                         const LastKnown& last, const MotionLimits& limits) const {
  const Scene::Item& item = scene_.items()[model];
  const auto own = [&](const Eigen::VectorXd& state) -> Eigen::VectorXd {
    return state.segment(item.offset, item.model->dimension());
  };
  const PoseSearch& search = *searches_[model];
  const double turn = std::min(0.25 + last.seconds, 1.2);
  const Eigen::Vector3d was = search.center(last.state);
  std::vector<PoseGuess> out;
  if (last.hint.size() > 0)
    out.push_back({search.center(last.hint), own(last.hint), kNearHint, kHintTurn});
  if (last.near_hint_only) return out;
  if (last.seconds < kRemembered) out.push_back({was, own(last.state), kNearLast, turn});
  const double reach = reach_within(limits, last.seconds).position + search.radius();
  for (const Place& place : places.best)
    if ((place.center - was).norm() <= reach)
      out.push_back({place.center, own(last.state), kNearPlace, turn});
  return out;
}

std::vector<Refined> Recovery::poses(FrameSearch& search, const Frame& frame, Judge& judge,
                                     std::size_t model, const Eigen::VectorXd& base,
                                     const std::vector<bool>& hidden,
                                     std::vector<PoseGuess> guesses, std::uint64_t seed) {
  const Scene::Item& item = scene_.items()[model];
  const ColorMap colors = search.second_view_colors();
  std::uint32_t part = 0;
  // Costs of different places do not compare: what the pictures show does.
  const auto around = [&](const PoseGuess& guess, const PoseEffort& effort) {
    std::vector<Refined> found = searches_[model]->find(search, frame, base, hidden, guess, effort,
                                                        seed_of_part(seed, part++));
    ModelJudge& of_model = judge.model(model);
    std::vector<Refined> seen;
    for (Refined& one : found) {
      const Evidence evidence = of_model.look(frame, one.state, colors);
      // Behind another model it may be anything.
      if (evidence.covered > kCovered) continue;
      one.cost = -of_model.log_odds(evidence);
      Eigen::VectorXd state = base;
      state.segment(item.offset, item.model->dimension()) =
          one.state.segment(item.offset, item.model->dimension());
      one.state = std::move(state);
      seen.push_back(std::move(one));
    }
    return seen;
  };
  std::vector<Refined> all;
  std::vector<std::pair<double, std::size_t>> ranks;
  for (std::size_t i = 0; i < guesses.size(); ++i) {
    const PoseEffort glance{settings_.hypotheses / 2, kGlance};
    double best = std::numeric_limits<double>::infinity();
    for (Refined& one : around(guesses[i], glance)) {
      best = std::min(best, one.cost);
      all.push_back(std::move(one));
    }
    ranks.emplace_back(best, i);
  }
  std::ranges::sort(ranks);
  ranks.resize(std::min(ranks.size(), kThorough));
  for (const auto& [rank, i] : ranks) {
    if (!std::isfinite(rank)) continue;
    const PoseEffort thorough{settings_.hypotheses, settings_.refined};
    for (Refined& one : around(guesses[i], thorough)) all.push_back(std::move(one));
  }
  std::ranges::stable_sort(all, [](const Refined& a, const Refined& b) { return a.cost < b.cost; });
  return all;
}

Candidates Recovery::find(FrameSearch& search, const Frame& frame, Judge& judge,
                          const LastKnown& last, const std::vector<bool>& lost,
                          const MotionLimits& limits, std::uint64_t seed) {
  Candidates out;
  const ColorMap colors = search.second_view_colors();
  std::vector<Places> places(lost.size());
  bool any_seen = false;
  for (std::size_t m = 0; m < lost.size(); ++m) {
    if (!lost[m]) continue;
    ModelJudge& model = judge.model(m);
    places[m] = finders_[m].find(frame, model.colors(), colors,
                                 static_cast<std::size_t>(settings_.places), kApart);
    any_seen = any_seen || !model.experienced() ||
               places[m].seen >= kSeen * model.usual(Evidence::kInside);
  }
  out.in_view = any_seen;
  if (!any_seen) return out;

  const auto several = std::count(lost.begin(), lost.end(), true) > 1;
  std::vector<Refined> whole{{last.state, 0, 0}};
  std::vector<bool> hidden = lost;
  for (std::size_t m = 0; m < lost.size(); ++m) {
    if (!lost[m]) continue;
    const std::vector<PoseGuess> all = guesses(m, places[m], last, limits);
    std::vector<Refined> more;
    for (std::size_t k = 0; k < std::min(whole.size(), several ? kOfEach : 1); ++k) {
      const std::uint64_t part = seed_of_part(seed, static_cast<std::uint32_t>(8 * m + k));
      for (Refined& one : poses(search, frame, judge, m, whole[k].state, hidden, all, part)) {
        out.evaluations += std::exchange(one.evaluations, 0);
        one.cost += whole[k].cost;
        more.push_back(std::move(one));
      }
    }
    std::ranges::stable_sort(more,
                             [](const Refined& a, const Refined& b) { return a.cost < b.cost; });
    const auto count = static_cast<std::size_t>(settings_.searched);
    more = distinct(scene_, std::move(more), several ? kDistinctModels : kDistinctPoses,
                    std::max(count, kOfEach));
    if (!more.empty()) whole = std::move(more);
    hidden[m] = false;
  }
  const Reach reach = reach_within(limits, last.seconds);
  for (const Refined& one : whole) {
    if (out.states.size() >= static_cast<std::size_t>(settings_.searched)) break;
    if (is_within(scene_, reach, last.state, one.state)) out.states.push_back(one.state);
  }
  return out;
}

}  // namespace hypotrack
