#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>

namespace hypotrack::calibrate {

/// Two pictures taken at the same time.
struct PicturePair {
  std::string name;  ///< of the left file, or the number of a video's frame
  cv::Mat left, right;
};

/// Reads pairs: of files with wildcards, each side sorted by name, or of two videos of which every
/// `step`-th frame counts. Calls `take` for each. Throws DataError if nothing matches, the numbers
/// of files differ, or a file cannot be read.
void read_pairs(const std::string& left, const std::string& right, int step,
                const std::function<void(PicturePair)>& take);

}  // namespace hypotrack::calibrate
