#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calibrate/stereo_calibration.hpp"
#include "calibrate/wanted_poses.hpp"

namespace hypotrack::calibrate {

/// What is seen in the two pictures of a moment.
struct PairLook {
  enum class Board { missing, moving, known, taken };
  Board board = Board::missing;  ///< `known`: a pair of this pose was taken before
  /// Why the board cannot be used in the left and the right picture; empty: it can.
  std::array<std::string, 2> problems;
};

/// Takes pairs of a live camera when a board holds still in both pictures and its pose is new.
class PairCollector {
 public:
  /// `finder` must outlive the collector. All pictures have the size `picture`.
  PairCollector(const BoardFinder& finder, cv::Size picture);

  /// Looks at the two pictures of a moment, in seconds of a clock that does not run back.
  PairLook look(double time, const cv::Mat& left, const cv::Mat& right);

  const std::vector<BoardPair>& pairs() const { return pairs_; }
  /// Returns what the pairs cover and lack.
  PoseCoverage coverage() const { return pose_coverage(pairs_, poses_, picture_); }

 private:
  /// A board that was found, and when.
  struct Sight {
    BoardCorners corners;
    double time = 0;
  };

  void find(std::size_t view, double time, const cv::Mat& picture, BoardPair& pair,
            std::string& problem);
  std::string why_missing(std::size_t view, double time, const cv::Mat& picture) const;
  bool holds_still(double time, BoardPair pair);

  const BoardFinder* finder_;
  cv::Size picture_;
  std::vector<BoardPair> pairs_;
  std::vector<RoughPose> poses_;              ///< of `pairs_` in the left pictures
  std::array<std::optional<Sight>, 2> last_;  ///< the newest board of each view
  std::optional<BoardPair> still_;            ///< from which the board has not moved
  double still_since_ = 0;
  int still_looks_ = 0;
};

}  // namespace hypotrack::calibrate
