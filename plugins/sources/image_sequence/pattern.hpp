#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hypotrack {

/// Selection of a recording's images.
struct Selection {
  std::optional<int> start;  ///< number (printf) or position (glob) of the first frame
  int step = 1;
  std::optional<int> count;
};

/// The images of one view: a path for every frame, which need not exist.
using ImageList = std::vector<std::filesystem::path>;

/// The images of a recording.
struct Images {
  std::vector<ImageList> views;  ///< of equal length
  int first = 0;                 ///< number (printf) or position (glob) of the first frame
};

/// Expands patterns, one per view, to lists of equal length. A pattern is one of
///   left_%04d.png   a number per frame: %d, %5d or %05d, in a file or folder name. Numbers that no
///                   view has between the first and the last frame are gaps, and stay in the list
///   left_*.png      * and ? in the file name; sorted so that 9 comes before 10
///   left.png        one frame
/// Throws DataError if nothing is found, if glob patterns find different numbers of files, or if
/// the numbers are so sparse that most frames would be gaps.
Images find_images(const std::vector<std::filesystem::path>& patterns, const Selection& selection);

/// Returns whether `a` sorts before `b`, with runs of digits compared as numbers.
bool natural_less(const std::string& a, const std::string& b);

}  // namespace hypotrack
