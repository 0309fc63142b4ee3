#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <opencv2/core/types.hpp>
#include <vector>

#include "network.hpp"

namespace hypotrack::hands {

struct HandPicture;

/// Columns of Palm::points.
inline constexpr int kPalmWrist = 0, kPalmMiddle = 2;

/// A palm that may be in a picture, in pixels; pixel centres are at integers.
struct Palm {
  double score = 0;                    ///< 0 to 1
  Eigen::AlignedBox2d box{};           ///< without the fingers
  Eigen::Matrix<double, 2, 7> points;  ///< wrist and knuckles
};

/// Finds palms in pictures by MediaPipe's palm detector. Several threads may use it.
class PalmDetector {
 public:
  /// Reads the network. Throws DataError as Network does.
  explicit PalmDetector(const std::filesystem::path& file);

  /// Returns the palms of at least that score, best first, in a part of a picture. A palm shorter
  /// than some 1/15 of the part's longer side is not found.
  std::vector<Palm> find(const HandPicture& picture, const cv::Rect& part,
                         double least_score) const;

 private:
  Network network_;
  std::vector<Eigen::Vector2d> anchors_;
};

/// Returns the palms, best first, with overlapping ones made one: their mean, weighted by score.
std::vector<Palm> without_overlaps(std::vector<Palm> palms);

}  // namespace hypotrack::hands
