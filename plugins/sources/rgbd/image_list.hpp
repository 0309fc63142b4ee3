#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace hypotrack::rgbd {

/// A picture and when it was taken.
struct TimedImage {
  double time = 0;  ///< seconds since any epoch
  std::filesystem::path file;
};

/// Reads a list as the TUM RGB-D benchmark has it: a time in seconds and a file name per line, with
/// spaces, tabs or a comma between them; empty lines and what begins with # are left out. Relative
/// names refer to the list's folder. Throws DataError, naming file and line, if it cannot be read,
/// is empty or no text, if a line is not understood, or if times do not ascend.
std::vector<TimedImage> read_image_list(const std::filesystem::path& list);

/// For every picture of `a` the index of the one of `b` that belongs to it: each is the other's
/// nearest in time, and they are at most `max_difference` seconds apart. Both lists ascend, and are
/// not empty.
std::vector<std::optional<std::size_t>> associate(std::span<const TimedImage> a,
                                                  std::span<const TimedImage> b,
                                                  double max_difference);

/// Index of the picture nearest in time; the earlier one of two equally near. `images` ascends and
/// is not empty.
std::size_t nearest(std::span<const TimedImage> images, double time);

}  // namespace hypotrack::rgbd
