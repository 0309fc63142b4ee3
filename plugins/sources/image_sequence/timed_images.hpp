#pragma once

#include <filesystem>
#include <vector>

#include "pattern.hpp"
#include "timestamps.hpp"

namespace hypotrack {

/// The images of a recording and when they were taken.
struct TimedImages {
  Images images;
  std::vector<Stamp> stamps;  ///< of the frames, which grow; empty: unknown
};

/// Expands patterns as find_images() does, and gives every frame its time if the settings say where
/// times are.
///
/// In a file, the first time is that of the first image found, wherever the selection starts, and
/// every number up to the last has one. In names, the time stands for the one * of each pattern.
/// Pictures of different patterns are of one frame if each is the other's nearest and they are at
/// most `tolerance` apart. A picture without a partner makes a frame of its own, whose other
/// pictures are missing: their paths have the partner's time.
///
/// Throws DataError as find_images() and read_stamps() do, if there are more or fewer times than
/// images, if a name has no time or two have the same, or if no picture has a partner.
TimedImages find_timed_images(const std::vector<std::filesystem::path>& patterns,
                              const Selection& selection, const TimestampSettings& settings);

/// Returns a note for the user if the names of images look like times, which are not read; else an
/// empty text.
std::string note_on_names(const ImageList& images);

}  // namespace hypotrack
