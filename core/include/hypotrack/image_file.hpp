#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack {

// Readers of recorded images, for sources. They never throw: an unusable image is a problem of its
// frame, not the end of the run. Missing, empty, truncated and undecodable files are always
// problems. EXIF orientation is ignored, because cameras are calibrated for the stored pixels.

/// An image, or the reason why it is missing.
struct ReadImage {
  cv::Mat image;
  std::string problem;  ///< names the file; empty on success
};

/// Reads an image as 8-bit BGR. Grey becomes three equal channels; alpha is dropped, not blended.
/// 16-bit values are scaled so that 2^bits - 1 becomes 255. Floating-point images are problems.
HYPOTRACK_API ReadImage read_color(const std::filesystem::path& file, int bits = 16);

/// Reads a mask as 8-bit, one channel: 255 where any colour channel is non-zero.
HYPOTRACK_API ReadImage read_mask(const std::filesystem::path& file);

/// Reads a 16-bit depth image of one channel as View::depth: 32-bit float metres, 0 where not
/// measured. A stored value of 1 is `unit` metres. Other formats are problems.
HYPOTRACK_API ReadImage read_depth(const std::filesystem::path& file, double unit);

/// Returns a message if the image of `file` does not have its camera's size, else an empty text.
HYPOTRACK_API std::string size_problem(const std::filesystem::path& file, const cv::Mat& image,
                                       const Camera& camera);

}  // namespace hypotrack
