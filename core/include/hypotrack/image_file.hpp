#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "hypotrack/camera.hpp"
#include "hypotrack/export.hpp"

namespace hypotrack {

// Pictures of recordings, for sources. A picture that cannot be used is a problem of its frame, not
// the end of the run: nothing here throws. Missing, empty, truncated and undecodable files are
// problems of every kind of picture. EXIF orientation is ignored: cameras are calibrated for the
// pixels as they are stored.

/// An image, or why there is none.
struct ReadImage {
  cv::Mat image;
  std::string problem;  ///< names the file; empty if all is well
};

/// Reads a picture as 8-bit BGR: grey becomes three equal channels, alpha is dropped (not blended),
/// 16-bit values are scaled so that 2^bits - 1 becomes 255. Floating-point pictures are problems.
HYPOTRACK_API ReadImage read_color(const std::filesystem::path& file, int bits = 16);

/// Reads a mask as 8-bit with one channel: 255 where any colour channel is not zero.
HYPOTRACK_API ReadImage read_mask(const std::filesystem::path& file);

/// Reads depth, 16 bits and one channel of `unit` metres each, as View::depth has it: 32-bit float
/// metres, 0 where not measured. Anything else than 16 bits and one channel is a problem.
HYPOTRACK_API ReadImage read_depth(const std::filesystem::path& file, double unit);

/// Says that an image read from `file` has not the size of its camera; empty if it has.
HYPOTRACK_API std::string size_problem(const std::filesystem::path& file, const cv::Mat& image,
                                       const Camera& camera);

}  // namespace hypotrack
