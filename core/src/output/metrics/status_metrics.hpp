#pragma once

#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "base/exported.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

inline constexpr double kRightErrorMm = 10;  ///< up to this error a frame should be tracked
inline constexpr double kFalseErrorMm = 20;  ///< beyond this error no frame should be tracked

/// Status that a tracker gives a frame.
enum class FrameStatus {
  tracked,
  uncertain,
  lost,     ///< the tracker lost the scene
  absent,   ///< the tracker found that the scene is in no picture
  missing,  ///< there is no solution; its values are ignored
  solved,   ///< there is a solution without a status, as of other trackers
};

/// Returns the status that a word of a status column means, all but `solved`; nothing for other
/// words.
std::optional<FrameStatus> status_named(std::string_view word);

/// Metrics of how well a tracker's statuses fit the truth, and of how it recovers;
/// docs/reference/metrics.md defines every number. NaN: unknown, because no frame has the data for
/// it.
struct StatusMetrics {
  int judged_frames = 0;  ///< with a status, missing ones included
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

/// Statuses that a tracker gives a frame and its models.
struct FrameStatuses {
  FrameStatus frame = FrameStatus::solved;
  std::vector<FrameStatus> models = {};  ///< of each model; empty: all have the frame's
};

/// Collects StatusMetrics frame by frame.
class StatusCollector {
 public:
  /// Status and truth of one model in a frame.
  struct ModelStatus {
    FrameStatus status = FrameStatus::solved;
    double error_mm = std::numeric_limits<double>::quiet_NaN();  ///< NaN: unknown
    bool in_view = false;  ///< the truth knows some landmark's position
    bool absent = false;   ///< the truth says that the model is in no picture
    double sigma_mm = std::numeric_limits<double>::quiet_NaN();  ///< mean over its landmarks; NaN:
                                                                 ///< unknown
  };

  /// Adds the next frame: the status of all, and of each model. The number of models must not
  /// change.
  void add(FrameStatus status, const std::vector<ModelStatus>& models);

  StatusMetrics metrics() const;

 private:
  /// A share of a number of frames.
  struct Share {
    int part = 0, of = 0;
    void add(bool is_part);
    double value() const;
  };
  /// A model's time in view after an absence.
  struct Return {
    int frames = 0;     ///< so far
    int recovered = 0;  ///< frame of recovery, counted from 1; 0: not yet
  };
  /// Presence of a model, carried from frame to frame.
  struct Presence {
    int absent_in_a_row = 0;
    bool away = false;     ///< it was absent from the last frame
    bool is_back = false;  ///< it came back and stayed
    Return last = {};
  };
  void add_status(FrameStatus status);
  void add_model(const ModelStatus& model, Presence& presence);
  void add_return(const ModelStatus& model, Presence& presence);

  StatusMetrics counts_;
  Share false_tracked_, right_tracked_, absent_tracked_;
  std::vector<Presence> models_;
  std::vector<Return> returns_;  ///< finished ones
  double least_lost_sigma_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace internal
}  // namespace hypotrack
