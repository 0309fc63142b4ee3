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
  int lowest = 0;                ///< the same of the first frame that exists
  int highest = 0;               ///< and of the last one
};

/// Expands patterns, one per view, to lists of equal length. A pattern is one of
///   left_%04d.png   a number per frame: %d, %5d or %05d, in a file or folder name. Numbers that no
///                   view has between the first and the last frame are gaps, and stay in the list
///   left_*.png      * and ? in the file name; sorted so that 9 comes before 10
///   left.png        one frame
/// Throws DataError if nothing is found, if glob patterns find different numbers of files, or if
/// the numbers are so sparse that most frames would be gaps.
Images find_images(const std::vector<std::filesystem::path>& patterns, const Selection& selection);

/// Finds the files of a pattern with * or ? in its file name, sorted by natural_less().
ImageList glob(const std::filesystem::path& pattern);

/// Returns the positions that a selection takes from a list. Throws DataError, naming `pattern`, if
/// these are none.
std::vector<std::size_t> positions(const Selection& selection, std::size_t size,
                                   const std::filesystem::path& pattern);

/// Throws DataError, naming the patterns, because they find no image.
[[noreturn]] void nothing_found(const std::vector<std::filesystem::path>& patterns,
                                const std::string& what_is_there = {});

/// Returns whether `a` sorts before `b`, with runs of digits compared as numbers.
bool natural_less(const std::string& a, const std::string& b);

}  // namespace hypotrack
