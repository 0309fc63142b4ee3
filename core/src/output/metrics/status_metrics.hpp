#pragma once

#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "hypotrack/export.hpp"

namespace hypotrack {

inline constexpr double kRightErrorMm = 10;  ///< up to it a frame should be tracked
inline constexpr double kFalseErrorMm = 20;  ///< beyond it none should be

/// What a tracker says of a frame, apart from where the landmarks are.
enum class FrameVerdict {
  tracked,
  uncertain,
  lost,     ///< the tracker itself says that it lost the scene
  absent,   ///< the tracker says that the scene is in no picture
  missing,  ///< there is no solution; what is given for it counts for nothing
  solved,   ///< there is a solution and no word about it: another tracker's
};

/// The verdict that a word of a status column means, all but `solved`; nothing for another word.
HYPOTRACK_API std::optional<FrameVerdict> verdict_named(std::string_view word);

/// How true it is what a tracker says of its frames, and how it comes back;
/// docs/reference/metrics.md defines every number. NaN: unknown, because no frame has what it takes.
struct StatusMetrics {
  int judged_frames = 0;  ///< with a verdict, missing ones included
  int tracked_frames = 0;
  int uncertain_frames = 0;
  int said_lost_frames = 0;
  int absent_frames = 0;
  double tracked_share = 0;
  double uncertain_share = 0;
  double absent_share = 0;
  double false_tracked_share = 0;
  double right_tracked_share = 0;
  double absent_tracked_share = 0;
  int returns = 0;
  double recovered_2_share = 0;
  double recovered_10_share = 0;
  double frames_to_recovery = 0;
  double lost_sigma_min_mm = 0;
};

/// What a tracker says of a frame.
struct FrameVerdicts {
  FrameVerdict frame = FrameVerdict::solved;
  std::vector<FrameVerdict> models = {};  ///< of each model; empty: the frame's of all
};

/// Collects StatusMetrics frame by frame.
class HYPOTRACK_API StatusCollector {
 public:
  /// What is known of one model in a frame.
  struct Judged {
    FrameVerdict verdict = FrameVerdict::solved;
    double error_mm = std::numeric_limits<double>::quiet_NaN();  ///< NaN: unknown
    bool in_view = false;  ///< the truth knows where some landmark is
    bool absent = false;   ///< the truth says that the model is in no picture
    double sigma_mm = std::numeric_limits<double>::quiet_NaN();  ///< mean; NaN: unknown
  };

  /// Adds the next frame: the verdict of all, and as many models as in every frame.
  void add(FrameVerdict verdict, const std::vector<Judged>& models);

  StatusMetrics metrics() const;

 private:
  /// Part of a number of frames.
  struct Share {
    int part = 0, of = 0;
    void add(bool is_part);
    double value() const;
  };
  /// A time in view after an absence.
  struct Return {
    int frames = 0;     ///< so far
    int recovered = 0;  ///< in which of them, from 1; 0: in none yet
  };
  /// What is known of a model from one frame to the next.
  struct Presence {
    int absent_in_a_row = 0;
    bool away = false;     ///< it was absent from the last frame
    bool is_back = false;  ///< it came back, and stayed
    Return last = {};
  };
  void add_verdict(FrameVerdict verdict);
  void add_model(const Judged& model, Presence& presence);
  void add_return(const Judged& model, Presence& presence);

  StatusMetrics counts_;
  Share false_tracked_, right_tracked_, absent_tracked_;
  std::vector<Presence> models_;
  std::vector<Return> returns_;  ///< that are over
  double least_lost_sigma_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace hypotrack
