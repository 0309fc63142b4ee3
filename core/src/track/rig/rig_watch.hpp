#pragma once

#include <deque>
#include <opencv2/core/matx.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/linearization.hpp"
#include "tile/color_map.hpp"
#include "track/rig/rectified_pair.hpp"
#include "track/rig/rig_fit.hpp"
#include "track/rig/view_timing.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Watches whether the pictures of a pair of cameras agree with their calibration, are taken at the
/// same time and stay as bright. It looks at whole pictures, often at first and then twice a
/// second, and at what moves until that tells the time between the views, anew after some seconds.
/// Outlines of tracked models tell how the second camera is turned.
class RigWatch {
 public:
  /// Returns nothing for cameras that are not nearly parallel: it cannot compare their
  /// pictures.
  /// `corrects_turn`: correction() includes the turns of look_at_turn().
  static std::optional<RigWatch> make(const std::vector<Camera>& cameras,
                                      bool corrects_turn = false);

  /// Takes the next frame as it came. Frames without two views of colour teach nothing.
  void look(const Frame& frame);
  /// Returns whether look() measures rows of which little is known: do it before the frame is
  /// searched. Later measurements may take effect in the next frame.
  bool learns_rows() const { return frames_ < kInterval && frames_ >= next_; }
  /// Takes the map from the second view's colours to the first's in a frame that was tracked.
  void look_at_colors(int frame, const ColorMap& colors);
  /// Takes how the second camera seems turned in a frame that was tracked, with correction().
  void look_at_turn(int frame, const CameraTurn& turn);

  /// Returns the inverse of the map that moves the second view's pictures to where the calibration
  /// has them; nothing if they are there.
  std::optional<cv::Matx33d> correction() const;
  /// Returns whether depth may be wrong in spite of that.
  bool is_doubtful() const { return is_late_ || misaligned_ > kMostRows || is_turned_; }

  /// Returns what the user should know, each thing once, since the last call.
  std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }
  const RigEstimate& estimate() const { return estimate_; }

 private:
  RigWatch(RectifiedPair pair, bool corrects_turn);
  void look_at_rows(const GreyPair& pictures, int frame);
  void look_at_time(const GreyPair& pictures, int frame);

  static constexpr int kInterval = 30;    ///< frames from one measurement of rows to the next
  static constexpr double kMostRows = 8;  ///< pixels that moving a picture makes up for

  RectifiedPair pair_;
  RigFit fit_;
  RigEstimate estimate_;
  int frames_ = 0, next_ = 0;  ///< number of frames, the one that is measured next
  ViewTiming timing_;
  int timed_from_ = 0;            ///< number of a frame: not before
  double time_ = 0;               ///< of the last frame
  std::deque<double> intervals_;  ///< between recent frames, seconds
  bool is_timed_ = false;         ///< the time between the views was told before
  bool is_late_ = false, late_said_ = false;
  double misaligned_ = 0;  ///< pixels in the second view; 0: not surely
  int color_frames_ = 0;   ///< that taught colours at the start
  double brightness_ = 0;  ///< of the first view against the second, after those
  int other_frames_ = 0;   ///< frames in a row with another brightness
  bool brightness_said_ = false;
  bool is_moved_ = true;  ///< corrected() applies to the last frame
  bool corrects_turn_, turn_said_ = false;
  bool is_turned_ = false;     ///< by so much that depth is wrong, and not corrected
  std::vector<double> turns_;  ///< radians, of the frames since the last conclusion
  double turn_ = 0;            ///< radians that correction() undoes
  std::vector<std::string> notes_;
};

/// Returns a frame with the pictures of the second of two views moved by RigWatch::correction().
Frame corrected(const Frame& frame, const std::optional<cv::Matx33d>& correction);

}  // namespace internal
}  // namespace hypotrack
