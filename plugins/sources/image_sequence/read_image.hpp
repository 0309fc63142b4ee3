#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

namespace hypotrack {

/// An image, or why there is none.
struct ReadImage {
  cv::Mat image;
  std::string problem;  ///< empty if all is well
};

/// Reads a picture as 8-bit BGR: grey becomes three equal channels, alpha is dropped (not blended),
/// 16-bit values are scaled so that 2^bits - 1 becomes 255. Missing, empty, truncated and
/// undecodable files and floating-point pictures are problems. EXIF orientation is ignored: cameras
/// are calibrated for the pixels as they are stored.
ReadImage read_color(const std::filesystem::path& file, int bits);

/// Reads a mask as 8-bit with one channel: 255 where any colour channel is not zero.
ReadImage read_mask(const std::filesystem::path& file);

}  // namespace hypotrack
