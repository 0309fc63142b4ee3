#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "hypotrack/api/media.hpp"

namespace hypotrack::test {

/// A number of little-endian or big-endian bytes.
inline std::string bytes_of(std::uint32_t value, int size, bool big_endian = false) {
  std::string out;
  for (int i = 0; i < size; ++i)
    out += static_cast<char>(value >> (8 * (big_endian ? size - 1 - i : i)));
  return out;
}

/// Exif of an orientation alone.
inline std::string exif(int orientation, bool big_endian = false) {
  const auto number = [&](std::uint32_t value, int size) {
    return bytes_of(value, size, big_endian);
  };
  const std::string entry = number(274, 2) + number(3, 2) + number(1, 4) +
                            number(static_cast<std::uint32_t>(orientation), 2) + number(0, 2);
  return (big_endian ? "MM" : "II") + number(42, 2) + number(8, 4) + number(1, 2) + entry +
         number(0, 4);
}

inline std::string encoded(const char* extension, const cv::Mat& image,
                           const std::vector<int>& parameters = {}) {
  const std::vector<unsigned char> bytes = encode_image(extension, image, parameters);
  return {bytes.begin(), bytes.end()};
}

/// Puts Exif into the bytes of a JPEG file.
inline std::string jpeg_with(const std::string& exif, std::string jpeg) {
  using namespace std::string_literals;
  const std::string content = "Exif\0\0"s + exif;
  return jpeg.insert(
      2, "\xFF\xE1" + bytes_of(static_cast<std::uint32_t>(content.size() + 2), 2, true) + content);
}

/// Puts Exif into the bytes of a PNG file.
inline std::string png_with(const std::string& exif, std::string png) {
  constexpr std::size_t kBehindHeader = 8 + 25;
  const std::string chunk = "eXIf" + exif;
  std::uint32_t check = 0xFFFFFFFF;
  for (const char c : chunk) {
    check ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) check = check >> 1 ^ (check & 1 ? 0xEDB88320 : 0);
  }
  return png.insert(kBehindHeader, bytes_of(static_cast<std::uint32_t>(exif.size()), 4, true) +
                                       chunk + bytes_of(~check, 4, true));
}

/// Puts Exif into the bytes of a WebP file of one chunk.
inline std::string webp_with(const std::string& exif, const std::string& webp, cv::Size size) {
  const std::string content = "WEBPVP8X" + bytes_of(10, 4) + bytes_of(8, 4) +
                              bytes_of(static_cast<std::uint32_t>(size.width - 1), 3) +
                              bytes_of(static_cast<std::uint32_t>(size.height - 1), 3) +
                              webp.substr(12) + "EXIF" +
                              bytes_of(static_cast<std::uint32_t>(exif.size()), 4) + exif;
  return "RIFF" + bytes_of(static_cast<std::uint32_t>(content.size()), 4) + content;
}

/// A TIFF file of one channel of 8 or 16 bits.
inline std::string tiff_with(int orientation, const cv::Mat& image) {
  const auto bits = static_cast<std::uint32_t>(8 * image.elemSize1());
  const auto width = static_cast<std::uint32_t>(image.cols);
  const auto height = static_cast<std::uint32_t>(image.rows);
  const std::uint32_t size = width * height * bits / 8;
  const std::vector<std::array<std::uint32_t, 2>> entries = {
      {256, width},
      {257, height},
      {258, bits},
      {259, 1},
      {262, 1},
      {273, 8 + 2 + 10 * 12 + 4},
      {274, static_cast<std::uint32_t>(orientation)},
      {277, 1},
      {278, height},
      {279, size}};
  std::string out = "II" + bytes_of(42, 2) + bytes_of(8, 4) + bytes_of(10, 2);
  for (const auto& [tag, value] : entries) {
    const bool is_long = tag == 273 || tag == 279;
    out += bytes_of(tag, 2) + bytes_of(is_long ? 4 : 3, 2) + bytes_of(1, 4) + bytes_of(value, 4);
  }
  out += bytes_of(0, 4);
  for (int y = 0; y < image.rows; ++y)
    out.append(reinterpret_cast<const char*>(image.ptr(y)), width * bits / 8);
  return out;
}

inline void write_bytes(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace hypotrack::test
