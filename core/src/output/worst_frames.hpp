#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"
#include "hypotrack/renderer.hpp"
#include "output/run_directory.hpp"
#include "picture/comparison.hpp"

namespace hypotrack {

/// A frame that is remembered for its error.
struct WorstFrame {
  int frame = 0;
  double error = 0;  ///< metres
  std::string status;
  cv::Mat picture;  ///< of the first view, its own copy
  ScenePose solution, truth;
};

/// Remembers the frames of largest error while a run goes on, at least kApart from each other, so
/// that one bad moment does not take every place: of frames 0 to 9, 10 to 19, ... the worst each,
/// then the worst of these, the worst of those that are not near it, and so on.
class HYPOTRACK_API WorstFrames {
 public:
  static constexpr int kApart = 10;

  explicit WorstFrames(int count) : count_(count) {}

  /// Whether offer() would remember a frame now. False for a NaN error.
  bool wants(int frame, double error) const;
  /// Remembers a frame that is wanted, and forgets the one whose place it takes.
  void offer(WorstFrame frame);

  /// Up to `count` frames, the worst first.
  std::vector<WorstFrame> frames() const;

  /// Draws worst_<frame>.jpg for each of them. Throws OutputError.
  void write(RunDirectory& directory, Renderer& renderer, const Camera& camera) const;

 private:
  /// A frame is near at most one other candidate on either side, so that among three times as many
  /// as are asked for there are always enough.
  std::size_t places() const { return 3 * static_cast<std::size_t>(count_); }

  int count_;
  std::vector<WorstFrame> candidates_;  ///< one of every kApart frames, up to places()
};

}  // namespace hypotrack
