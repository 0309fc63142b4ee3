#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace hypotrack::rgbd {

/// A picture and its time.
struct TimedImage {
  double time = 0;         ///< seconds since any epoch
  std::int64_t stamp = 0;  ///< the same in nanoseconds, which a double would round
  std::filesystem::path file;
};

/// Reads a list of images as in the TUM RGB-D benchmark: a time in seconds and a file name per
/// line, separated by spaces, tabs or a comma. Skips empty lines and lines that begin with #.
/// Relative names refer to the list's folder. Throws DataError, naming file and line, if the list
/// cannot be read, is empty or no text, if a line is malformed, or if times do not ascend.
std::vector<TimedImage> read_image_list(const std::filesystem::path& list);

/// Returns for every picture of `a` the index of its partner in `b`: each is the other's nearest in
/// time, and they are at most `max_difference` seconds apart. Both lists must ascend and not be
/// empty.
std::vector<std::optional<std::size_t>> associate(std::span<const TimedImage> a,
                                                  std::span<const TimedImage> b,
                                                  double max_difference);

/// Returns the times of pictures, nanoseconds.
std::vector<std::int64_t> stamps_of(std::span<const TimedImage> images);

}  // namespace hypotrack::rgbd
