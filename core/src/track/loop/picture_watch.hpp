#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/exported.hpp"
#include "cost/cost.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "hypotrack/plugin/linearization.hpp"
#include "tile/color_map.hpp"
#include "track/faults/picture_checks.hpp"
#include "track/faults/steady_brightness.hpp"
#include "track/rig/rig_watch.hpp"
#include "track/search/frame_search.hpp"
#include "track/side_work.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Watches pictures and cameras for faults, and makes up for those that allow it.
class PictureWatch {
 public:
  /// The terms must outlive it. `is_on`: otherwise it finds nothing but the faults that frames come
  /// with. `corrects_turn`: as RigWatch::make() says.
  PictureWatch(const std::vector<Camera>& cameras, const std::vector<ObjectiveTerm>& terms,
               bool is_on, bool corrects_turn = false);

  /// Returns the worst fault of the next frame. Call it with all frames that have views, in order.
  /// It takes a jump of brightness out of this frame and later ones, and may go on to look at the
  /// frame beside the search: call it within a FrameEnd's life.
  ViewFault check(const Frame& frame);
  /// Returns a frame as it is searched: as bright as before, and as the calibration says.
  Frame steadied(const Frame& frame) const;
  /// Takes the colours that a search learned from the frame before, and lets it follow slow changes
  /// of brightness since.
  void tell_drifts(FrameSearch& search);

  /// Takes the number of a frame, and whether its search is done. Returns whether depth may be
  /// wrong, for the cameras do not fit their calibration.
  bool doubts_depth(int frame, bool is_searched);
  /// Compares the views of a frame in which all models were tracked, perhaps not surely, by the
  /// outlines that a term prepared. Takes the models' state. Call it after doubts_depth().
  void compare_views(int frame, const Eigen::VectorXd& state);
  /// Returns what the pictures show to be wrong with the cameras, since the last call.
  std::vector<std::string> take_notes();

  /// Waits at its end until nothing looks at a frame any more.
  class FrameEnd {
   public:
    explicit FrameEnd(PictureWatch& watch) : watch_(watch) {}
    ~FrameEnd();
    FrameEnd(const FrameEnd&) = delete;
    FrameEnd& operator=(const FrameEnd&) = delete;

   private:
    PictureWatch& watch_;
  };

 private:
  std::optional<PictureChecks> checks_;
  SteadyBrightness brightness_;
  std::optional<RigWatch> rig_;            ///< of a pair of views that are compared
  const CameraTurnTerm* views_ = nullptr;  ///< judges each view by itself; null: no term does
  const Objective* turning_ = nullptr;     ///< that term
  std::optional<cv::Matx33d> correction_;  ///< RigWatch::correction() as of the last check()
  std::optional<int> searched_;            ///< frame whose learned colours it has not taken
  std::optional<std::pair<int, ColorMap>> colors_;  ///< of such a frame, to be looked at
  SideWork looking_{"look at the rig"};             ///< beside the search
};

}  // namespace internal
}  // namespace hypotrack
