#pragma once

#include <memory>
#include <string>

#include "base/exported.hpp"
#include "hypotrack/media.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Opens a video file with FFmpeg. Returns null, and why in `problem`, if that fails.
std::unique_ptr<VideoFile> open_file(const std::string& file, std::string& problem);

}  // namespace internal
}  // namespace hypotrack
