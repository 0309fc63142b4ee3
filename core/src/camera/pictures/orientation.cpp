#include "camera/pictures/orientation.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

#include "camera/pictures/picture_container.hpp"

namespace hypotrack::internal {
namespace {

constexpr int kUpright = 1;

int in_tiff(std::string_view bytes) {
  constexpr std::uint32_t kOrientation = 274;
  const std::uint32_t value = tiff_directory(bytes).value(kOrientation);
  return value >= 1 && value <= 8 ? static_cast<int>(value) : kUpright;
}

/// Exif 2.3, 4.7.2: a TIFF file, which follows a name in JPEG files and in some others.
int in_exif(std::string_view bytes) {
  using namespace std::string_view_literals;
  constexpr std::string_view kName = "Exif\0\0"sv;
  return in_tiff(bytes.starts_with(kName) ? bytes.substr(kName.size()) : bytes);
}

/// Returns whether a part of a file is Exif: an APP1 of JPEG, a chunk of PNG or WebP.
bool is_exif(std::string_view name, std::string_view content) {
  return name == "eXIf" || name == "EXIF" || (name == "\xE1" && content.starts_with("Exif"));
}

}  // namespace

int orientation_of(std::string_view bytes) {
  if (is_tiff(bytes)) return in_tiff(bytes);
  int found = kUpright;
  for_each_part(bytes, [&](std::string_view name, std::string_view content) {
    if (!is_exif(name, content)) return true;
    found = in_exif(content);
    return false;
  });
  return found;
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
