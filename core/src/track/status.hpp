#pragma once

#include <deque>

#include "base/exported.hpp"
#include "hypotrack/api/solution.hpp"
#include "hypotrack/plugin/judge.hpp"
#include "hypotrack/plugin/params.hpp"
#include "tile/foreground_overlap.hpp"
#include "track/motion_limits.hpp"
#include "track/recover/recovery_settings.hpp"
#include "track/uncertainty_settings.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// `status:` of a scene, and what is in its `recovery` and `uncertainty`.
struct StatusSettings {
  MotionLimits motion;
  RecoverySettings recovery;
  int history = 30;
  double outlier = 6.0;
  int patience = 15;
  double min_visible = 0.3;
  double uncertain_sigma = 0.010;
  double lost_sigma = 0.040;
  UncertaintySettings uncertainty;
  bool check_pictures = true;
  bool correct_turn = false;
  // Of the scene's judge, which has its own section.
  bool judged = false;  ///< by a judge, who looks at the pictures; false: by costs alone
  JudgeThresholds thresholds = {};
  void visit(ParamVisitor& v) {
    v("motion", motion, {.help = "how fast models move at most"});
    v("history", history,
      {.help = "past frames whose costs say what to expect", .min = 5, .max = 10000});
    v("outlier", outlier,
      {.help = "uncertain above median + this many robust standard deviations of those costs",
       .min = 1,
       .max = 1000});
    v("patience", patience,
      {.help = "frames in a row with outliers, or half out of view, that make lost",
       .min = 1,
       .max = 100000});
    v("min_visible", min_visible,
      {.help = "lost below this share of the models inside every image; uncertain below twice it",
       .min = 0,
       .max = 0.5});
    v("uncertain_sigma_mm", uncertain_sigma,
      {.help = "with `uncertainty`: uncertain where a model's landmarks are expected to be off by "
               "more than this on average",
       .min = 1e-3,
       .max = 1e6,
       .unit = "mm",
       .to_si = kMillimetre});
    v("lost_sigma_mm", lost_sigma,
      {.help = "the same for lost", .min = 1e-3, .max = 1e6, .unit = "mm", .to_si = kMillimetre});
    v("check_pictures", check_pictures,
      {.help = "do not search frames with frozen, exchanged, black, white or doubled views, and "
               "report jumps of brightness"});
    v("correct_turn", correct_turn,
      {.help = "move the second view's pictures where the outlines of rigid models (objective "
               "`contour`) show that its camera is turned against the calibration"});
  }
};

/// Measurements that decide a status.
struct StatusMeasures {
  double cost = 0;         ///< infinite: no pose was found
  double probability = 0;  ///< that the pose is right, from the pictures; NaN: unknown
  double visible = 0;      ///< share of the models' vertices that project into every image
  double sigma = 0;        ///< mean over a model's landmarks, in metres; NaN: unknown
  ForegroundOverlap foreground_overlap = ForegroundOverlap::unknown;
  bool in_view = true;     ///< false: a search of the whole pictures did not find the model
  bool confirmed = false;  ///< searches from other starts ended in the same pose
  bool detected = false;   ///< a detector sees the model near this pose
};

/// Decides the status of a model in a frame. Where the pictures do not tell whether a pose is
/// right, it compares the cost with those of past frames.
class StatusMonitor {
 public:
  explicit StatusMonitor(const StatusSettings& settings) : settings_(settings) {}

  Status judge(const StatusMeasures& measures);

  /// Returns the probability that a pose needs to count as tracked now: more just after a loss,
  /// less before anything was tracked.
  double needed() const {
    constexpr int kSteady = 4;  // frames in a row that reach `tracked_above`
    if (!ever_tracked_) return settings_.thresholds.first_above;
    return steady_ < kSteady ? settings_.thresholds.certain_above
                             : settings_.thresholds.tracked_above;
  }

  /// Asks of the first pose what is asked of later ones: no start tells where the model is.
  void expect_no_start() { settings_.thresholds.first_above = settings_.thresholds.tracked_above; }
  /// Asks of the first pose what is asked just after a loss: the start was wrong.
  void distrust_start() { ever_tracked_ = true; }

  /// Returns the threshold above which a cost is an outlier of recent frames; -infinity with too
  /// few.
  double usual_cost() const;

 private:
  Status decide(const StatusMeasures& measures);
  Status judge_by_cost(const StatusMeasures& measures);
  void remember(double cost);

  StatusSettings settings_;
  std::deque<double> costs_;  ///< of past frames, newest last
  int uncertain_in_a_row_ = 0;
  bool ever_tracked_ = false;
  int steady_ = 0;  ///< frames in a row that were tracked or reached `tracked_above`
};

}  // namespace internal
}  // namespace hypotrack
