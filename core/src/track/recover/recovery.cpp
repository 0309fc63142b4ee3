#include "track/recover/recovery.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "base/profile.hpp"
#include "hypotrack/plugin/search.hpp"
#include "track/recover/silhouette.hpp"
#include "track/verify/surface_points.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kFinderWindow = 0.75;  // of a model's radius: what a place is looked for by
constexpr double kSeen = 0.35;          // of the colours that a tracked model shows: it is in view
// Shares of hypotheses near the last rotation, around a pose and at a place.
constexpr double kNearPose = 0.75, kNearPlace = 0.25;
constexpr double kHopeless = 4;  // -log odds: no search makes such a candidate right
// Factors where a model was never seen: of the poses that are scored and refined, of those
// searched, and of the places.
constexpr int kUnknownEffort = 6, kUnknownSearched = 2, kUnknownPlaces = 2;
// Poses that the costs alone choose among many where a model was never seen.
constexpr int kUnknownKept = 16;
constexpr double kPlaceScatter = 0.02, kUnknownScatter = 0.03;  // metres
constexpr double kHeldCovered = 0.7;  // largest hidden share of a held model
constexpr double kDistinct = 0.012;   // metres between candidates, mean over the model's landmarks
constexpr Eigen::Index kSurfacePoints = 2000;  // that show the colours of a texture
constexpr double kTexel = 0.002;               // metres, as pictures show a texture
constexpr double kHides = 0.35;  // share of another model that a candidate may newly hide

}  // namespace

std::span<const std::string_view> enum_names(RecoveryRun) {
  static constexpr std::array<std::string_view, 2> names{"frame", "background"};
  return names;
}

GlobalSearchSettings share_of(GlobalSearchSettings effort, double share) {
  for (int* count : {&effort.hypotheses, &effort.refined})
    *count = std::max(1, static_cast<int>(std::lround(share * *count)));
  return effort;
}

Recovery::Recovery(const Scene& scene, const std::vector<Camera>& cameras,
                   const RecoverySettings& settings)
    : scene_(scene), cameras_(cameras), settings_(settings), in_view_(scene.items().size(), true) {
  for (std::size_t m = 0; m < scene.items().size(); ++m) {
    searches_.push_back(std::make_unique<PoseSearch>(scene, m, cameras, settings));
    finders_.emplace_back(cameras, kFinderWindow * searches_[m]->radius(), settings.nearest,
                          settings.farthest);
    const Mesh& mesh = scene.items()[m].model->data().mesh;
    surfaces_.push_back(texture_colors(mesh, spread_points(mesh, kSurfacePoints), kTexel));
    searched_.emplace_back(cameras, searches_[m]->radius());
    searched_held_.push_back(searched_.back());
  }
}

void Recovery::remember(const Eigen::VectorXd& state, const std::vector<bool>& tracked) {
  for (std::size_t m = 0; m < searches_.size(); ++m) {
    if (!tracked[m]) continue;
    in_view_[m] = true;
    searched_[m].forget();
    searched_held_[m].forget();
    const Scene::Item& item = scene_.items()[m];
    searches_[m]->postures().remember(state.segment(item.offset, item.model->dimension()));
  }
}

Recovery::Reduction::Reduction(Recovery& recovery, const Frame* frame) : recovery_(recovery) {
  if (!frame || frame->views.size() < 2 || !recovery.reducing_.has_thread()) return;
  recovery.reduced_ = {};
  recovery.reducing_.begin([&recovery, frame] { recovery.reduced_ = recovery.reduced(*frame); });
}

Recovery::Reduction::~Reduction() {
  try {
    recovery_.reducing_.wait();
  } catch (...) {  // learn_backgrounds() tries again
  }
}

Recovery::ReducedFrame Recovery::reduced(const Frame& frame) const {
  ReducedFrame out{frame.index};
  tbb::parallel_for(std::size_t{0}, out.pictures.size(), [&](std::size_t i) {
    const cv::Mat& picture = frame.views[i].color;
    if (!picture.empty()) out.pictures[i] = finders_[0].reduced(picture, i);
  });
  return out;
}

void Recovery::learn_backgrounds(const Frame& frame, const Eigen::VectorXd& state) {
  if (frame.views.size() < 2) return;
  if (reduced_.index != frame.index) reduced_ = reduced(frame);
  learning_.begin([this, pictures = std::exchange(reduced_, {}).pictures, state] {
    tbb::parallel_for(std::size_t{0}, pictures.size(), [&](std::size_t i) {
      if (!pictures[i].empty()) learn_background(i, pictures[i], state);
    });
  });
}

void Recovery::learn_background(std::size_t view, const cv::Mat3b& picture,
                                const Eigen::VectorXd& state) {
  constexpr int kMargin = 3;  // reduced pixels around silhouettes
  const cv::Mat square =
      cv::getStructuringElement(cv::MORPH_RECT, {2 * kMargin + 1, 2 * kMargin + 1});
  cv::Mat1b models = silhouettes(scene_, std::vector<bool>(searches_.size(), true), state,
                                 cameras_[view], finders_[0].reduction(view));
  cv::dilate(models, models, square);
  backgrounds_[view].learn(picture, models);
}

ForegroundColors Recovery::colors_of(const Task& task) const {
  ForegroundColors colors = task.verifier.model(task.model).colors();
  const std::vector<View>& views = task.frame.views;
  if (colors.known() || surfaces_[task.model].empty()) return colors;
  std::vector<cv::Mat3b> pictures;
  for (std::size_t i = 0; i < std::min<std::size_t>(2, views.size()); ++i)
    if (!views[i].color.empty())
      pictures.push_back(finders_[task.model].reduced(views[i].color, i));
  colors.expect(surfaces_[task.model], pictures);
  return colors;
}

Places Recovery::places(const Task& task) {
  learning_.wait();
  const PlaceFinder& finder = finders_[task.model];
  const std::vector<View>& views = task.frame.views;
  std::vector<bool> others = task.hidden;
  others.flip();
  std::array<cv::Mat1f, 2> weights;
  for (std::size_t i = 0; i < std::min<std::size_t>(2, views.size()); ++i) {
    if (views[i].color.empty()) continue;
    weights[i] = backgrounds_[i].changed(finder.reduced(views[i].color, i));
    weights[i].setTo(
        0, silhouettes(scene_, others, task.last.state, cameras_[i], finder.reduction(i)));
  }
  if (!task.verifier.model(task.model).colors().known() && views.size() >= 2 &&
      !weights[0].empty() && !weights[1].empty()) {
    if (!depths_)
      depths_.emplace(cameras_, std::array{finder.reduction(0), finder.reduction(1)},
                      settings_.nearest, settings_.farthest);
    const std::array<cv::Mat1f, 2> near =
        depths_->weights({finder.reduced(views[0].color, 0), finder.reduced(views[1].color, 1)});
    for (std::size_t i = 0; i < 2; ++i) weights[i] = weights[i].mul(near[i]);
  }
  const int count = settings_.places * (std::isfinite(task.last.seconds) ? 1 : kUnknownPlaces);
  return finder.find(task.frame, colors_of(task), task.search.second_view_colors(),
                     static_cast<std::size_t>(count), weights);
}

std::vector<PoseGuess> Recovery::guesses(const Task& task, const Places& places,
                                         const MotionLimits& limits) {
  const Scene::Item& item = scene_.items()[task.model];
  const LastKnown& last = task.last;
  const auto own = [&](const Eigen::VectorXd& state) -> Eigen::VectorXd {
    return state.segment(item.offset, item.model->dimension());
  };
  const PoseSearch& search = *searches_[task.model];
  const double turn = std::min(0.25 + last.seconds, 1.2);
  const Eigen::Vector3d was = search.center(last.state);
  std::vector<PoseGuess> out;
  if (last.hint.size() > 0)
    out.push_back({search.center(last.hint), own(last.hint), kNearPose, turn});
  if (last.near_hint_only) return out;
  if (last.before.size() > 0)
    for (std::size_t m = 0; m < task.hidden.size(); ++m)
      if (m != task.model && !task.hidden[m]) out.push_back(beside(task, m));
  EmptyPlaces& searched = (task.held.empty() ? searched_ : searched_held_)[task.model];
  const bool is_known = std::isfinite(last.seconds);
  if (is_known && searched.is_worth(task.frame, was))
    out.push_back({was, own(last.state), kNearPose, turn});
  const double reach =
      is_known ? reach_within(limits, last.seconds).position + search.radius() : last.seconds;
  for (const Place& place : places.best)
    if ((place.center - was).norm() <= reach && searched.is_worth(task.frame, place.center))
      out.push_back({.center = place.center,
                     .pose = own(last.state),
                     .near_share = is_known ? kNearPlace : 0,
                     .rotation = turn,
                     .scatter = is_known ? kPlaceScatter : kUnknownScatter,
                     .centred = !is_known});
  searched.end_frame();
  return out;
}

PoseGuess Recovery::beside(const Task& task, std::size_t other) const {
  constexpr double kShare = 0.9, kTurn = 0.15, kScatter = 0.006;
  const Scene::Item& own = scene_.items()[task.model];
  const Eigen::VectorXd state =
      moved_with(scene_, task.model, other, task.last.before, task.last.state);
  PoseGuess out{searches_[task.model]->center(state),
                state.segment(own.offset, own.model->dimension()), kShare, kTurn, kScatter};
  out.covered = kHeldCovered;
  return out;
}

bool Recovery::hides_others(const Task& task, const Eigen::VectorXd& state,
                            const ColorMap& colors) {
  for (std::size_t m = 0; m < task.hidden.size(); ++m)
    if (!task.hidden[m] && task.verifier.model(m).measured(task.frame, state, colors).covered >
                               task.covered[m] + kHides)
      return true;
  return false;
}

Recovery::Task Recovery::begin(FrameSearch& search, const Frame& frame, PoseVerifier& verifier,
                               LastKnown last, std::size_t model, const std::vector<bool>& shown,
                               const std::vector<bool>& held) {
  Task task{search, frame, verifier, model, std::move(last), shown};
  task.hidden[model] = false;
  task.hidden.flip();
  for (std::size_t m = 0; m < held.size(); ++m)
    if (held[m])
      task.held.push_back({m, pose_of(scene_.items()[model], task.last.before).inverse() *
                                  pose_of(scene_.items()[m], task.last.before)});
  task.in_view = in_view_[model] || !verifier.experienced(model);
  const Eigen::VectorXd others = searches_[model]->without(task.last.state, task.hidden);
  for (std::size_t m = 0; m < shown.size(); ++m)
    task.covered.push_back(
        task.hidden[m]
            ? 0
            : verifier.model(m).measured(frame, others, search.second_view_colors()).covered);
  return task;
}

void Recovery::look(Task& task, const MotionLimits& limits) {
  const ProfiledPart part("find places");
  if (std::exchange(task.looked, true)) return;
  if (task.last.near_hint_only) {
    task.guesses = guesses(task, {}, limits);
    return;
  }
  const Places seen = places(task);
  const ModelVerifier& of_model = task.verifier.model(task.model);
  task.in_view = !of_model.experienced() || seen.seen >= kSeen * of_model.usual(Measures::kInside);
  in_view_[task.model] = task.in_view;
  if (task.in_view) task.guesses = guesses(task, seen, limits);
}

Candidates Recovery::find(const Task& task, const PoseGuess& guess,
                          const GlobalSearchSettings& effort, const MotionLimits& limits,
                          std::uint64_t seed) {
  const ProfiledPart part("find poses");
  const Scene::Item& item = scene_.items()[task.model];
  const Eigen::VectorXd& base = task.last.state;
  const ColorMap colors = task.search.second_view_colors();
  const bool is_known = std::isfinite(task.last.seconds);
  const auto or_usual = [&](int wanted, int usual, int unknown) {
    return wanted > 0 ? wanted : usual * (is_known ? 1 : unknown);
  };
  const int refined = or_usual(effort.refined, settings_.refined, kUnknownEffort);
  const HypothesisCounts counts{or_usual(effort.hypotheses, settings_.hypotheses, kUnknownEffort),
                                refined, is_known ? refined : kUnknownKept};
  PoseVerifier& verifier = task.verifier;
  const Reach reach = reach_within(limits, is_known ? task.last.seconds : 1);
  FoundPoses found = searches_[task.model]->find(task.search, task.frame, base, task.hidden,
                                                 task.held, guess, counts, seed);
  Candidates out{{}, found.evaluations};
  std::vector<Refined> seen;
  for (Refined& one : found.poses) {
    const Measures measures = verifier.model(task.model).measured(task.frame, one.state, colors);
    // Behind another model any pose fits.
    if (measures.covered > guess.covered || hides_others(task, one.state, colors)) continue;
    const double odds = verifier.log_odds(measures);
    if (-odds > kHopeless) continue;
    // With learned colours the judge tells more than costs, without them less.
    if (verifier.experienced(task.model)) one.cost = -odds;
    Eigen::VectorXd state = base;
    state.segment(item.offset, item.model->dimension()) =
        one.state.segment(item.offset, item.model->dimension());
    Eigen::VectorXd from = base;
    for (const HeldModel& held : task.held) {
      const Scene::Item& with = scene_.items()[held.model];
      for (Eigen::VectorXd* to : {&state, &from}) set_pose(with, pose_of(with, one.state), *to);
    }
    if (is_known && !is_within(scene_, reach, from, state)) continue;
    one.state = std::move(state);
    seen.push_back(std::move(one));
  }
  leave_distinct(
      scene_, kDistinct / static_cast<double>(scene_.items().size()),
      static_cast<std::size_t>(or_usual(effort.searched, settings_.searched, kUnknownSearched)),
      seen);
  for (Refined& one : seen) out.states.push_back(std::move(one.state));
  return out;
}

}  // namespace hypotrack::internal
