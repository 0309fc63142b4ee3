#include "camera/orientation.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

namespace hypotrack::internal {
namespace {

constexpr int kUpright = 1;

/// Reads numbers of either byte order; those beyond the end are 0.
class Numbers {
 public:
  Numbers(std::string_view bytes, bool big_endian) : bytes_(bytes), big_endian_(big_endian) {}

  std::uint32_t at(std::size_t offset, std::size_t size) const {
    if (offset > bytes_.size() || bytes_.size() - offset < size) return 0;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t byte = offset + (big_endian_ ? i : size - 1 - i);
      value = value << 8 | static_cast<unsigned char>(bytes_[byte]);
    }
    return value;
  }

 private:
  std::string_view bytes_;
  bool big_endian_;
};

bool is_tiff(std::string_view bytes) {
  using namespace std::string_view_literals;
  return bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv);
}

/// TIFF 6.0, section 2: the header, and the entries of the first directory.
int in_tiff(std::string_view bytes) {
  constexpr std::uint32_t kOrientation = 274, kShort = 3;
  if (!is_tiff(bytes)) return kUpright;
  const Numbers numbers(bytes, bytes.front() == 'M');
  const std::size_t directory = numbers.at(4, 4);
  const std::size_t entries = numbers.at(directory, 2);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    if (entry >= bytes.size()) break;
    if (numbers.at(entry, 2) != kOrientation) continue;
    const std::uint32_t value = numbers.at(entry + 8, numbers.at(entry + 2, 2) == kShort ? 2 : 4);
    return value >= 1 && value <= 8 ? static_cast<int>(value) : kUpright;
  }
  return kUpright;
}

/// Exif 2.3, 4.7.2: a TIFF file, which follows a name in JPEG files and in some others.
int in_exif(std::string_view bytes) {
  using namespace std::string_view_literals;
  constexpr std::string_view kName = "Exif\0\0"sv;
  return in_tiff(bytes.starts_with(kName) ? bytes.substr(kName.size()) : bytes);
}

/// ITU-T T.81, B.1.1: segments up to the first scan; Exif is an APP1.
int in_jpeg(std::string_view bytes) {
  constexpr std::uint32_t kApp1 = 0xE1, kScan = 0xDA, kEnd = 0xD9, kFill = 0xFF;
  const Numbers numbers(bytes, true);
  for (std::size_t at = 2; at + 4 <= bytes.size() && bytes[at] == '\xFF';) {
    const std::uint32_t marker = numbers.at(at + 1, 1);
    if (marker == kScan || marker == kEnd) break;
    if (marker == kFill) {
      ++at;
      continue;
    }
    const std::size_t size = numbers.at(at + 2, 2);
    if (size < 2) break;
    const std::string_view content = bytes.substr(at + 4, size - 2);
    if (marker == kApp1 && content.starts_with("Exif")) return in_exif(content);
    at += 2 + size;
  }
  return kUpright;
}

/// Looks for a chunk of a PNG (big endian; 4 bytes of checksum follow) or of a WebP file.
int in_chunks(std::string_view bytes, bool png) {
  const Numbers numbers(bytes, png);
  for (std::size_t at = png ? 8 : 12; at + 8 <= bytes.size();) {
    const std::size_t size = numbers.at(png ? at : at + 4, 4);
    const std::string_view name = bytes.substr(png ? at + 4 : at, 4);
    if (name == (png ? "eXIf" : "EXIF")) return in_exif(bytes.substr(at + 8, size));
    at += 8 + size + (png ? 4 : size % 2);
  }
  return kUpright;
}

bool is_webp(std::string_view bytes) {
  return bytes.starts_with("RIFF") && bytes.size() > 12 && bytes.substr(8, 4) == "WEBP";
}

}  // namespace

int orientation_of(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xD8\xFF")) return in_jpeg(bytes);
  if (bytes.starts_with("\x89PNG\r\n")) return in_chunks(bytes, true);
  if (is_webp(bytes)) return in_chunks(bytes, false);
  return in_tiff(bytes);
}

std::string_view turn_of(int orientation) {
  constexpr std::array<std::string_view, 8> kTurns = {"not turned",
                                                      "mirrored",
                                                      "turned by 180 degrees",
                                                      "mirrored and turned by 180 degrees",
                                                      "mirrored and turned by 90 degrees",
                                                      "turned by 90 degrees clockwise",
                                                      "mirrored and turned by 90 degrees",
                                                      "turned by 90 degrees counterclockwise"};
  return kTurns.at(static_cast<std::size_t>(orientation - 1));
}

void turn_upright(cv::Mat& image, std::string_view bytes) {
  const int orientation = is_tiff(bytes) ? kUpright : orientation_of(bytes);
  if (orientation == kUpright) return;
  // OpenCV flips by rows (0), columns (1) or both (-1).
  constexpr int kNone = 2;
  constexpr std::array<int, 8> kFlips = {kNone, 1, -1, 0, kNone, 1, -1, 0};
  cv::Mat turned = image;
  if (orientation >= 5) cv::transpose(image, turned);
  cv::Mat flipped = turned;
  const int flip = kFlips.at(static_cast<std::size_t>(orientation - 1));
  if (flip != kNone) cv::flip(turned, flipped, flip);
  image = flipped;
}

std::string advice_on_turn(int width, int height, int expected_width, int expected_height) {
  if (width == height || width != expected_height || height != expected_width) return {};
  return fmt::format(
      "; turned by 90 degrees it fits. Pictures are turned as their EXIF orientation, and videos "
      "as "
      "their rotation says: calibrate with pictures of {}x{} as viewers show them, or remove the "
      "turn from the files",
      width, height);
}

}  // namespace hypotrack::internal
