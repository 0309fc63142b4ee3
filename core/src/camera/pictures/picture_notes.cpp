#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <opencv2/core.hpp>

#include "camera/pictures/orientation.hpp"
#include "hypotrack/api/image_file.hpp"

namespace hypotrack {
namespace {

using Files = std::span<const std::filesystem::path>;

/// Type and largest value of the first pictures.
struct Values {
  std::filesystem::path first;  ///< picture that can be read
  int depth = CV_8U;
  bool said = false;  ///< by the format, how large values may be
  int pictures = 0;
  double largest = 0;
};

/// Returns the largest value of the colours.
double largest_value(const cv::Mat& image) {
  double largest = 0;
  const bool alpha = image.channels() % 2 == 0;
  cv::Mat channel;
  for (int c = 0; c < image.channels() - (alpha ? 1 : 0); ++c) {
    double value = 0;
    cv::extractChannel(image, channel, c);
    cv::minMaxLoc(channel, nullptr, &value);
    largest = std::max(largest, value);
  }
  return largest;
}

/// Returns a picture, empty if it cannot be read.
DecodedFile picture_of(const std::filesystem::path& file) {
  try {
    return decode_upright(file);
  } catch (const std::exception&) {  // memory; the frame says so
    return {};
  }
}

Values values_of(Files files) {
  constexpr int kEnough = 5;
  Values values;
  for (const std::filesystem::path& file : files) {
    const DecodedFile decoded = picture_of(file);
    const cv::Mat& picture = decoded.image;
    if (picture.empty()) continue;
    if (values.pictures++ == 0) {
      values.first = file;
      values.said = decoded.white && *decoded.white < 65535;
      values.depth = picture.depth();
    }
    if (values.depth != CV_16U || picture.depth() != CV_16U) break;
    values.largest = std::max(values.largest, largest_value(picture));
    if (values.pictures == kEnough) break;
  }
  return values;
}

/// Returns the usual number of bits of a camera that a value needs; 16 if none is smaller.
int usual_bits(double largest) {
  constexpr std::array<int, 4> kUsual = {8, 10, 12, 14};
  const auto enough = std::ranges::find_if(kUsual, [&](int b) { return largest < (1 << b); });
  return enough == kUsual.end() ? 16 : *enough;
}

}  // namespace

std::string orientation_note(Files files) {
  constexpr std::size_t kLooked = 16;
  const std::size_t looked = std::min(kLooked, files.size());
  int first = 0, turned = 0;  // orientations; 0: none yet
  bool alike = true;
  std::size_t shown = 0;
  for (std::size_t i = 0; i < looked; ++i) {
    const std::size_t at = i * files.size() / looked;
    const int found = file_orientation(files[at]);
    if (found == 0) continue;
    if (first == 0) first = found;
    alike = alike && found == first;
    if (turned != 0 || found == 1) continue;
    turned = found;
    shown = at;
  }
  if (turned == 0) return {};
  std::string note = fmt::format(
      "{}: its EXIF orientation is {}: it is {}, as viewers show it; the calibration must be of "
      "pictures as viewers show them",
      files[shown].string(), turned, turn_of(turned));
  if (!alike)
    note += fmt::format(
        ". Other pictures of these have another orientation, though a camera does not turn between "
        "two: clear it in all (exiftool -Orientation= -overwrite_original FILES), and calibrate "
        "with such pictures");
  return note;
}

std::string bits_note(Files files, std::optional<int> bits, std::string_view setting) {
  const Values values = values_of(files);
  const std::string file = values.first.string();
  if (values.pictures == 0) return {};
  if (values.depth != CV_16U)
    return bits ? fmt::format("{}: has 8 bits; `{} {}` is for pictures of 16 bits, and is ignored",
                              file, setting, *bits)
                : "";
  const int needed = usual_bits(values.largest);
  if (!bits && needed < 16 && values.largest > 0 && !values.said)
    return fmt::format(
        "{}: no value of the first {} exceeds {}, so that they look like {} bits in 16. They are "
        "read as 16 bits, {} times darker: set `{} {}`, or `{} 16` if the scene is that dark",
        file, values.pictures == 1 ? "picture" : fmt::format("{} pictures", values.pictures),
        values.largest, needed, 1 << (16 - needed), setting, needed, setting);
  if (bits && values.largest >= (1 << *bits))
    return fmt::format("{}: has values up to {}; with `{} {}` all above {} are white: set `{} {}`",
                       file, values.largest, setting, *bits, (1 << *bits) - 1, setting, needed);
  return {};
}

}  // namespace hypotrack
