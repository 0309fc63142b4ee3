#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "base/exported.hpp"
#include "hypotrack/plugin/output.hpp"
#include "picture/comparison.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// A frame that is kept for its large error.
struct WorstFrame {
  int frame = 0;
  double error = 0;  ///< metres
  std::string status;
  cv::Mat picture;  ///< copy of the first view
  ScenePose solution, truth;
};

/// Keeps the frames of largest error of a run, at least kApart from each other, so that one bad
/// moment does not take all places. It keeps the worst of frames 0 to 9, of 10 to 19, and so on.
/// Among these it picks the worst, then the worst that is not near it, and so on.
class WorstFrames {
 public:
  static constexpr int kApart = 10;

  explicit WorstFrames(int count) : count_(count) {}

  /// Returns whether offer() would keep a frame now. False for a NaN error.
  bool wants(int frame, double error) const;
  /// Keeps a wanted frame and forgets the one whose place it takes.
  void offer(WorstFrame frame);

  /// Returns up to `count` frames, the worst first.
  std::vector<WorstFrame> frames() const;

  /// Draws worst_<frame>.jpg for each of them, in the first view. Throws OutputError.
  void write(OutputContext& run) const;

 private:
  /// Returns the number of candidates to keep. A frame is near at most one other candidate on
  /// either side, so three times the count always leaves enough.
  std::size_t places() const { return 3 * static_cast<std::size_t>(count_); }

  int count_;
  std::vector<WorstFrame> candidates_;  ///< the worst of every kApart frames, up to places()
};

}  // namespace internal
}  // namespace hypotrack
