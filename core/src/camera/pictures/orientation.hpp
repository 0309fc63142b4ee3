#pragma once

#include <cstddef>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "base/exported.hpp"
#include "base/file_bytes.hpp"
#include "hypotrack/api/image_file.hpp"

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns the orientation, 1 to 8, that a JPEG, PNG, WebP or TIFF file asks viewers for (Exif 2.3,
/// tag 274); 1, upright, if it asks for none or is damaged.
int orientation_of(std::string_view bytes);

/// Describes how viewers turn a picture of this orientation: `turned by 90 degrees clockwise`.
std::string_view turn_of(int orientation);

/// Turns a decoded file as viewers do. Decoders turn TIFF files themselves, others not.
void turn_upright(cv::Mat& image, std::string_view bytes);

/// Pixels of a file as stored.
struct DecodedFile : ReadImage {
  std::optional<int> white;  ///< largest value of 16 bits, if the format says it
};

/// Decodes a file's pixels as stored, and turns them as viewers do. Throws if memory lacks.
DecodedFile decode_upright(const std::filesystem::path& file);

/// Reads a file's bytes. Returns a problem if they are none of a whole picture.
std::string read_picture_bytes(const std::filesystem::path& file, FileBytes& bytes);

/// Returns the orientation_of() a file; 0 if it cannot be read.
int file_orientation(const std::filesystem::path& file);

/// Returns what to add to a message on a picture's size if a turn by 90 degrees explains it.
std::string advice_on_turn(int width, int height, int expected_width, int expected_height);

/// Keeps up to `bytes` of the pixels that read_color(), read_mask() and read_depth() return from
/// now on, for later readers of the same files: runs of a study mostly share their recordings.
void keep_read_images(std::size_t bytes);

}  // namespace internal
}  // namespace hypotrack
