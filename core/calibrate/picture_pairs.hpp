#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hypotrack/api/media.hpp"
#include "hypotrack/api/stereo_layout.hpp"

namespace hypotrack::calibrate {

/// Two pictures taken at the same time.
struct PicturePair {
  std::string name;  ///< of the left file, or the number of a video's frame
  cv::Mat left, right;
};

/// Where pairs are: files with wildcards, each side sorted by name and number, or videos.
struct PairFiles {
  std::string left, right;               ///< no right: with `layout`, left has both views
  int step = 1;                          ///< every `step`-th frame of videos counts
  std::optional<StereoLayout> layout{};  ///< of pictures of both views
  std::optional<int> bits{};             ///< significant bits of 16-bit pictures; 16 unless given
  VideoColors colors{};                  ///< of videos that say nothing or something wrong
};

/// Returns whether a file is a video by the ending of its name.
bool is_video(const std::filesystem::path& file);

/// Reads pairs and calls `take` for each, and `tell` with lines for the user, such as on the rates
/// of videos, which pair by time. Throws DataError if nothing matches, the numbers of files differ,
/// or a file cannot be read.
void read_pairs(
    const PairFiles& files, const std::function<void(PicturePair)>& take,
    const std::function<void(const std::string&)>& tell = [](const std::string&) {});

/// Returns lines for the user on how the pictures are read. Throws DataError if nothing matches.
std::vector<std::string> notes_on(const PairFiles& files);

}  // namespace hypotrack::calibrate
