#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "hypotrack/api/camera.hpp"
#include "hypotrack/api/export.hpp"

namespace hypotrack {

// Readers of recorded images, for sources. They never throw: an unusable image is a problem of its
// frame, not the end of the run. Missing, empty, truncated and undecodable files are always
// problems. Pictures are turned as EXIF says, as viewers show them: cameras are calibrated for
// that. The pixels may be those of other readers of the file, too: copy before you change them.

/// An image, or the reason why it is missing.
struct ReadImage {
  cv::Mat image;
  std::string problem;  ///< names the file; empty on success
};

/// Reads an image as 8-bit BGR. Grey becomes three equal channels; alpha is dropped, not blended.
/// 16-bit values are scaled so that 2^bits - 1, or the smaller maximum of a PGM or PPM header,
/// becomes 255. Floating-point images are problems.
HYPOTRACK_API ReadImage read_color(const std::filesystem::path& file, int bits = 16);

/// Reads a mask as 8-bit, one channel: 255 where any colour channel is non-zero. Transparent pixels
/// are 0, unless all are transparent.
HYPOTRACK_API ReadImage read_mask(const std::filesystem::path& file);

/// Reads a 16-bit depth image of one channel as View::depth: 32-bit float metres, 0 where not
/// measured. A stored value of 1 is `unit` metres. Other formats are problems.
HYPOTRACK_API ReadImage read_depth(const std::filesystem::path& file, double unit);

/// Returns a note for the user if EXIF says how to turn some of these files, which are read turned.
/// Looks at some of them; empty if none is turned. Missing files do not count.
HYPOTRACK_API std::string orientation_note(std::span<const std::filesystem::path> files);

/// Returns a note for the user if the first colour pictures are not of `bits` bits: their values
/// need fewer (without `bits`, which means 16) or more, or they are 8-bit. `setting` precedes the
/// number in the advice: `bits:`.
HYPOTRACK_API std::string bits_note(std::span<const std::filesystem::path> files,
                                    std::optional<int> bits, std::string_view setting = "bits:");

/// Returns a note for the user on what the first file holds beside the pixels that are read:
/// further pictures, a colour profile that is not sRGB. Empty if there is nothing.
HYPOTRACK_API std::string contents_note(std::span<const std::filesystem::path> files);

/// Returns a note for the user if masks are JPEG files, whose black is inexact.
HYPOTRACK_API std::string mask_note(std::span<const std::filesystem::path> files);

/// Returns a message if the image of `file` does not have its camera's size, else an empty text.
HYPOTRACK_API std::string size_problem(const std::filesystem::path& file, const cv::Mat& image,
                                       const Camera& camera);

}  // namespace hypotrack
