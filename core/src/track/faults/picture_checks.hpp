#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/frame.hpp"
#include "track/faults/frozen_views.hpp"
#include "track/faults/view_order.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A fault and the view that has it; -1: all.
struct ViewFault {
  FrameFault fault = FrameFault::none;
  int view = 0;
};

/// Looks for faults in the pictures of frames: in colour by small grey copies.
class PictureChecks {
 public:
  /// `with_depth`: an objective reads depth. Then a view whose depth is nowhere measured is a
  /// fault.
  PictureChecks(std::vector<Camera> cameras, bool with_depth);

  /// Returns the worst fault of the next frame. Colour is not checked in views with depth, as
  /// depth does not depend on the light. Call it with all frames that have views, in order.
  ViewFault check(const Frame& frame);

  /// Returns by how much each view of the last frame became brighter; 1: it did not jump.
  const std::vector<float>& jumps() const { return jumps_; }
  /// Returns by how much each view became brighter without a jump since the last frame that can be
  /// searched, as by an exposure that adapts; 1: unknown.
  const std::vector<float>& drifts() const { return drifts_; }

 private:
  ViewFault find(const SmallPictures& now);
  /// Returns the first view whose share of black or white cells says that it shows nothing.
  std::optional<int> empty_view(const SmallPictures& now, double SmallPicture::*share) const;
  /// Sets jumps_ and drifts_. Returns the first view that has one.
  std::optional<int> jumping_view(const SmallPictures& now);

  bool with_depth_;
  FrozenViews frozen_;
  std::optional<ViewOrder> order_;  ///< of the first two views
  SmallPictures good_;              ///< of the last frame without such a fault; empty: none yet
  std::vector<float> jumps_, drifts_;
};

/// Returns whether a frame with this fault has pictures that must not be searched.
bool spoils_pictures(FrameFault fault);

/// Describes a fault for the user: the finding, the tracker's reaction, and the remedy. `view` is
/// the view that has it, negative: all. Empty for FrameFault::none.
std::string describe(FrameFault fault, int view);

}  // namespace internal
}  // namespace hypotrack
