#pragma once

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/export.hpp"

namespace hypotrack {

/// What is wrong with a frame's pictures or time, as seen before its search. A frame with wrong
/// pictures is not searched: its status is `missing`.
enum class FrameFault {
  none,
  frozen,        ///< a view repeats its picture while another one moves
  same_picture,  ///< the first two views show one picture
  exchanged,     ///< the first two views match the cameras the other way round
  black,         ///< a view is black, or its depth is nowhere measured
  saturated,     ///< a view is white
  brightness,    ///< a view is suddenly brighter or darker; the frame is searched
  time_back,     ///< the time does not follow the one before; the frame is searched
  time_gap,      ///< no frame came for long; the frame is searched
};
HYPOTRACK_API std::string_view to_string(FrameFault fault);

/// The images of one camera as they came from the sensor (distorted, unrectified). A view has
/// colour, depth or both. Every image present has the size of its camera.
struct View {
  cv::Mat color{};  ///< 8-bit BGR; empty for a camera that gives depth only
  cv::Mat mask{};   ///< 8-bit foreground (non-zero); empty if unknown
  cv::Mat depth{};  ///< 32-bit float z along the optical axis, metres; 0 = not measured; empty
                    ///< without depth
};

/// The true state or landmarks of a frame; either may be missing.
struct GroundTruth {
  Eigen::VectorXd state{};       ///< state of the scene; size 0 = unknown
  Eigen::Matrix3Xd landmarks{};  ///< 3xL in the order of Scene::landmark_names(), world, metres;
                                 ///< NaN columns are unknown; size 0 = use `state`
  /// For each model, true if it is known to be out of view; its landmarks are then NaN. Empty:
  /// every model is in view.
  std::vector<bool> absent{};
};

/// All views of one instant of a recording.
struct Frame {
  int index = 0;              ///< number within the source; missing frames count
  double time = 0;            ///< seconds since the first frame
  std::vector<View> views{};  ///< one per camera of the source; empty if the frame is unusable
  std::optional<GroundTruth> truth{};
  std::string problem{};  ///< why `views` is empty (missing file, damaged image), else empty
  /// When a live source took the pictures, on the clock of this machine; empty for recordings.
  std::optional<std::chrono::steady_clock::time_point> taken{};
  /// What was wrong with the time, which is corrected. A run sets it; sources leave it as it is.
  FrameFault fault = FrameFault::none;
  /// When the pictures were taken, in nanoseconds on the recording's own clock; of a live source,
  /// since 1970 (Unix time). Empty if unknown. A source sets it in all frames or in none.
  std::optional<std::int64_t> stamp{};
};

}  // namespace hypotrack
