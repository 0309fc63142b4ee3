#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/api/scene.hpp"
#include "hypotrack/plugin/starter.hpp"
#include "track/color/background_model.hpp"
#include "track/motion_limits.hpp"
#include "track/recover/depth_weights.hpp"
#include "track/recover/empty_places.hpp"
#include "track/recover/held_models.hpp"
#include "track/recover/place_finder.hpp"
#include "track/recover/pose_search.hpp"
#include "track/recover/recovery_settings.hpp"
#include "track/search/frame_search.hpp"
#include "track/side_work.hpp"
#include "track/verify/pose_verifier.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// The last known pose of a lost model.
struct LastKnown {
  Eigen::VectorXd state;  ///< of the scene; the other models have their present poses
  double seconds = 0;     ///< time since then; infinite: it was never seen
  /// State with a guess of its present pose; empty if there is none.
  Eigen::VectorXd hint = {};
  bool near_hint_only = false;  ///< searches around the hint only
  /// The last state in which all models were surely tracked; empty: unknown.
  Eigen::VectorXd before = {};
};

/// States that a recovery found at one place.
struct Candidates {
  std::vector<Eigen::VectorXd> states;  ///< of the whole scene, best first, without hopeless ones
  std::int64_t evaluations = 0;
};

/// Returns a share of an effort: at least one hypothesis and one refinement.
GlobalSearchSettings share_of(GlobalSearchSettings effort, double share);

/// Searches whole pictures for a lost model: around its last place, and wherever both views show
/// its colours.
class Recovery {
 public:
  /// The search for one model in one frame.
  struct Task {
    FrameSearch& search;
    const Frame& frame;
    PoseVerifier& verifier;
    std::size_t model;
    LastKnown last;
    std::vector<bool> hidden = {};     ///< models that are not in the scene now, and the lost one
    std::vector<HeldModel> held = {};  ///< hidden models that move with the lost one
    std::vector<double> covered = {};  ///< share of each model that others hide
    bool in_view = true;  ///< false: no picture showed colours of the lost model lately
    bool looked = false;  ///< the guesses are known
    std::vector<PoseGuess> guesses = {};  ///< poses to search around, likeliest first
  };

  /// The scene must outlive the recovery.
  Recovery(const Scene& scene, const std::vector<Camera>& cameras,
           const RecoverySettings& settings);

  /// Begins the search for a model. Other models with `shown` keep their poses of `last`. Those
  /// with `held` move with the lost one (held_by()). The rest are hidden. All arguments must
  /// outlive the task.
  Task begin(FrameSearch& search, const Frame& frame, PoseVerifier& verifier, LastKnown last,
             std::size_t model, const std::vector<bool>& shown, const std::vector<bool>& held);

  /// Finds places where the model may be, except places that were searched in vain and look the
  /// same. Does so once per task: sweeps through whole pictures take their time.
  void look(Task& task, const MotionLimits& limits);

  /// Finds poses of the model, and of what it holds, at one of the places.
  Candidates find(const Task& task, const PoseGuess& guess, const GlobalSearchSettings& effort,
                  const MotionLimits& limits, std::uint64_t seed);

  /// Returns the search for poses of a model.
  const PoseSearch& search(std::size_t model) const { return *searches_[model]; }

  /// Reduces the pictures of a frame during its life, beside other work, for learn_backgrounds().
  class Reduction {
   public:
    /// Both must outlive it. Null: nothing will be learned.
    Reduction(Recovery& recovery, const Frame* frame);
    ~Reduction();
    Reduction(const Reduction&) = delete;
    Reduction& operator=(const Reduction&) = delete;

   private:
    Recovery& recovery_;
  };

  /// Learns the postures of the models with `tracked`, which are surely right.
  void remember(const Eigen::VectorXd& state, const std::vector<bool>& tracked);
  /// Learns the background, where all models are surely right: a lost one may be anywhere in it. It
  /// works beside what the caller does next, without the frame; look() throws its errors.
  void learn_backgrounds(const Frame& frame, const Eigen::VectorXd& state);

 private:
  /// The reduced pictures of a frame.
  struct ReducedFrame {
    std::optional<int> index = {};
    std::array<cv::Mat3b, 2> pictures = {};
  };

  ReducedFrame reduced(const Frame& frame) const;
  void learn_background(std::size_t view, const cv::Mat3b& picture, const Eigen::VectorXd& state);
  std::vector<PoseGuess> guesses(const Task& task, const Places& places,
                                 const MotionLimits& limits);
  Places places(const Task& task);
  /// Returns the colours to look for: those learned, or else those of the model's texture. Unknown
  /// where there is none.
  ForegroundColors colors_of(const Task& task) const;
  /// Returns the guess that the model has moved rigidly with another, as a held object does.
  PoseGuess beside(const Task& task, std::size_t other) const;
  /// Returns whether a state hides models that are visible without the lost one.
  static bool hides_others(const Task& task, const Eigen::VectorXd& state, const ColorMap& colors);

  const Scene& scene_;
  std::vector<Camera> cameras_;
  RecoverySettings settings_;
  std::vector<std::unique_ptr<PoseSearch>> searches_;
  std::vector<PlaceFinder> finders_;
  std::vector<std::vector<cv::Vec3f>> surfaces_;  ///< colours of each model's texture
  std::vector<EmptyPlaces> searched_;             ///< by model
  std::vector<EmptyPlaces> searched_held_;        ///< for searches with what it holds
  std::optional<DepthWeights> depths_;            ///< for models whose colours are unknown
  std::array<BackgroundModel, 2> backgrounds_;    ///< of the reduced pictures
  std::vector<bool> in_view_;                     ///< by model, when it was looked for last
  ReducedFrame reduced_;                          ///< by the last Reduction
  SideWork reducing_{"reduce pictures"}, learning_{"learn backgrounds"};
};

}  // namespace internal
}  // namespace hypotrack
