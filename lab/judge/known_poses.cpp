#include "lab/judge/known_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/plugin/kinematics.hpp"
#include "lab/judge/pose_recoveries.hpp"
#include "track/color/photometric.hpp"
#include "track/loop/scene_tracker.hpp"
#include "track/search/displace.hpp"
#include "track/verify/pose_verifier.hpp"

namespace hypotrack::internal {
namespace {

constexpr double kAway = std::numeric_limits<double>::infinity();
constexpr double kSureError = 0.010;  // metres; looks are learned from what is found within it
// A recovery takes as long as ten frames of tracking or more.
constexpr unsigned kRecoverEvery = 4;
constexpr int kDisplaced = 5;  // poses of a frame

/// Returns the mean distance of a model's landmarks in a state from the true ones.
double error_of(const Scene::Item& item, const Eigen::VectorXd& state,
                const Eigen::Matrix3Xd& truth, Eigen::Index first) {
  const std::span<const double> own(state.data() + item.offset,
                                    static_cast<std::size_t>(item.model->dimension()));
  const Eigen::Matrix3Xd found = posed_landmarks(*item.model, own);
  double sum = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < found.cols(); ++i) {
    const double distance = (found.col(i) - truth.col(first + i)).norm();
    if (std::isfinite(distance)) sum += distance, ++count;
  }
  return count > 0 ? sum / count : kAway;
}

/// Collects the poses of one sequence.
class Collection {
 public:
  Collection(const PoseSequence& sequence, PluginLoader& plugins)
      : sequence_(sequence),
        session_(open_scene(sequence.scene, sequence.overrides, plugins)),
        scene_(*session_.scene),
        cameras_(session_.source->cameras()),
        recoveries_(sequence.scene, sequence.overrides, plugins),
        random_(static_cast<std::uint64_t>(sequence.number + 1)),
        tiles_(scene_, cameras_, session_.parts.tile),
        photometric_(scene_, session_.parts.photometric) {
    if (cameras_.size() < 2)
      throw DataError(
          fmt::format("{}: its source has one view; judges compare two", sequence.scene.string()));
    if (!session_.parts.judge)
      throw ConfigError(fmt::format(
          "{}: found `judge: none`, expected a judge, whom recoveries ask; add --set judge=network",
          sequence.scene.string()));
    for (std::size_t m = 0; m < scene_.items().size(); ++m) {
      verifiers_.emplace_back(scene_, m, cameras_);
      fresh_.emplace_back(scene_, m, cameras_);
    }
  }

  std::vector<KnownPose> collect(const PoseProgress& progress) {
    for (int k = 0; k < sequence_.frames; ++k) {
      const std::optional<Frame> frame = session_.source->next();
      if (!frame) break;
      if (!frame->truth)
        throw DataError(fmt::format("{}: frame {} has no ground truth", sequence_.scene.string(),
                                    frame->index));
      if (!frame->views.empty()) look_at(*frame);
      if (progress && !progress(k)) break;
    }
    return std::move(poses_);
  }

 private:
  void look_at(const Frame& frame);
  void add_displaced(const Frame& frame);
  void add_recovered(const Frame& frame);
  void learn(const Frame& frame, const Eigen::VectorXd& found);
  /// Adds the models with `shown` in a state.
  void add(const Frame& frame, const Eigen::VectorXd& state, const std::vector<bool>& shown,
           bool searched);
  bool is_right(const Eigen::VectorXd& state) const;

  const PoseSequence& sequence_;
  OpenedScene session_;
  const Scene& scene_;
  std::vector<Camera> cameras_;
  PoseRecoveries recoveries_;
  std::mt19937_64 random_;
  TileMaker tiles_;
  PhotometricMatch photometric_;
  std::vector<ModelVerifier> verifiers_, fresh_;  ///< by model; the second ones learn nothing
  std::optional<SceneTracker> tracker_;
  std::vector<Eigen::VectorXd> past_;  ///< true states with all models in view
  Eigen::Matrix3Xd landmarks_;         ///< true ones of the frame
  std::vector<bool> absent_;
  ColorMap colors_;
  std::vector<KnownPose> poses_;
};

void Collection::add(const Frame& frame, const Eigen::VectorXd& state,
                     const std::vector<bool>& shown, bool searched) {
  std::vector<bool> hidden = shown;
  hidden.flip();
  tiles_.leave_out(hidden);
  if (tiles_.visible_share(state) == 0) return;
  Eigen::Index first = 0;
  for (std::size_t m = 0; m < verifiers_.size(); ++m) {
    const Scene::Item& item = scene_.items()[m];
    const double error = absent_[m] ? kAway : error_of(item, state, landmarks_, first);
    first += std::ssize(item.model->data().landmarks);
    if (!shown[m]) continue;
    for (ModelVerifier* verifier : {&verifiers_[m], &fresh_[m]}) {
      const Measures measures = verifier->measured(frame, state, colors_);
      if (measures.known) poses_.push_back({measures, error, searched, sequence_.number});
    }
  }
}

bool Collection::is_right(const Eigen::VectorXd& state) const {
  Eigen::Index first = 0;
  for (const Scene::Item& item : scene_.items()) {
    if (!(error_of(item, state, landmarks_, first) <= kSureError)) return false;
    first += std::ssize(item.model->data().landmarks);
  }
  return true;
}

void Collection::look_at(const Frame& frame) {
  const Eigen::VectorXd& truth = frame.truth->state;
  const std::vector<bool> all(scene_.items().size(), true);
  absent_ = frame.truth->absent;
  absent_.resize(all.size(), false);
  const bool complete = std::ranges::find(absent_, true) == absent_.end();
  if (complete) past_.push_back(truth);
  if (past_.empty()) return;
  if (!tracker_)
    tracker_.emplace(scene_, std::move(session_.parts), initial_state(session_, frame),
                     session_.seed);
  landmarks_ = frame.truth->landmarks.size() > 0 ? frame.truth->landmarks : scene_.landmarks(truth);
  tiles_.leave_out(std::vector<bool>(all.size(), false));
  TilePlan plan = tiles_.plan(frame, past_.back());
  if (!photometric_.knows()) photometric_.begin(tiles_, frame, plan, past_.back());
  photometric_.apply(plan);
  colors_ = plan.views[1].colors;
  const Eigen::VectorXd found = tracker_->track(frame).state;
  add(frame, found, all, true);
  if (complete) add(frame, truth, all, false);
  add_displaced(frame);
  add_recovered(frame);
  if (complete) learn(frame, found);
}

void Collection::add_displaced(const Frame& frame) {
  static constexpr double kLadder[] = {2, 4, 7, 10, 15, 20, 25, 30, 40, 60, 100, 200};  // mm
  for (int i = 0; i < kDisplaced; ++i) {
    const double mm = kLadder[random_() % std::size(kLadder)];
    const double kind = std::uniform_real_distribution<>(0, 1)(random_);
    const Displacement by{mm * kMillimetre * (kind < 0.7),
                          mm * 0.6 * kDegree * (kind > 0.3 && kind < 0.9),
                          mm * 0.8 * kDegree * (kind > 0.5)};
    add(frame, displaced(scene_, past_.back(), by, random_()),
        std::vector<bool>(absent_.size(), true), false);
  }
}

/// Adds poses of one model, found from where it was at some other time; the others are where they
/// are, or lost, too.
void Collection::add_recovered(const Frame& frame) {
  const std::size_t models = absent_.size(), model = random_() % models;
  const Scene::Item& item = scene_.items()[model];
  Eigen::VectorXd kept = past_.back();
  kept.segment(item.offset, item.model->dimension()) =
      past_[random_() % past_.size()].segment(item.offset, item.model->dimension());
  std::vector<bool> shown(models, random_() % 3 != 0), only(models, false);
  shown[model] = only[model] = true;
  const double seconds = std::uniform_real_distribution<>(0.05, 2)(random_);
  const auto add_shown = [&](Eigen::VectorXd state, bool searched) {
    for (std::size_t m = 0; m < models; ++m)
      if (!shown[m]) state.segment<3>(scene_.items()[m].offset) += Eigen::Vector3d(0, 0, -20);
    add(frame, state, only, searched);
  };
  if (random_() % kRecoverEvery != 0) return;
  const RecoveredStates found = recoveries_.find(frame, kept, seconds, model, shown, random_());
  for (const Eigen::VectorXd& state : found.candidates) add_shown(state, false);
  for (const Eigen::VectorXd& state : found.searched) add_shown(state, true);
}

/// Learns from what was found where that is right, else from the truth: they differ where the
/// pictures show another shape than the model's.
void Collection::learn(const Frame& frame, const Eigen::VectorXd& found) {
  const Eigen::VectorXd& right = is_right(found) ? found : frame.truth->state;
  for (ModelVerifier& verifier : verifiers_)
    verifier.learn(verifier.measured(frame, right, colors_));
  recoveries_.learn(frame, right);
  tiles_.leave_out(std::vector<bool>(absent_.size(), false));
  photometric_.learn(tiles_, frame, tiles_.plan(frame, right), right);
}

}  // namespace

std::vector<KnownPose> collect_known_poses(const PoseSequence& sequence, PluginLoader& plugins,
                                           const PoseProgress& progress) {
  return Collection(sequence, plugins).collect(progress);
}

}  // namespace hypotrack::internal
