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

/// Reads pairs: of files with wildcards, each side sorted by name, or of two videos, which pair by
/// time and of which every `step`-th frame counts. Calls `take` for each, and `tell` with lines for
/// the user, such as on the rates of videos. Throws DataError if nothing matches, the numbers of
/// files differ, or a file cannot be read.
void read_pairs(
    const std::string& left, const std::string& right, int step,
    const std::function<void(PicturePair)>& take,
    const std::function<void(const std::string&)>& tell = [](const std::string&) {});

}  // namespace hypotrack::calibrate
