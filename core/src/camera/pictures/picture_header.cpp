#include "camera/pictures/picture_header.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "camera/pictures/netpbm.hpp"
#include "camera/pictures/picture_container.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 27;

struct Size {
  std::uint64_t width = 0, height = 0;
};

/// Returns a big-endian number. The bytes must be there.
std::uint32_t number_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(at, count)) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

/// PNG, "11.2.2 IHDR Image header".
std::optional<Size> png_size(std::string_view bytes) {
  if (bytes.size() < 24) return std::nullopt;
  return Size{number_at(bytes, 16, 4), number_at(bytes, 20, 4)};
}

/// ITU-T T.81, "B.2.2 Frame header syntax": a frame header is a segment C0 to CF, but for three.
std::optional<Size> jpeg_size(std::string_view bytes) {
  std::size_t at = 2;
  while (true) {
    at = bytes.find('\xFF', at);
    if (at == std::string_view::npos || bytes.size() - at < 9) return std::nullopt;
    const std::uint32_t marker = number_at(bytes, at + 1, 1);
    const bool frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) return Size{number_at(bytes, at + 7, 2), number_at(bytes, at + 5, 2)};
    if (marker == 0xFF) {
      ++at;  // fills up
    } else if (marker == 0x00 || marker == 0x01 || (marker >= 0xD0 && marker <= 0xD9)) {
      at += 2;  // stands alone
    } else {
      at += 2 + number_at(bytes, at + 2, 2);
    }
  }
}

std::optional<Size> size_in_header(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n")) return png_size(bytes);
  if (bytes.starts_with("\xFF\xD8\xFF")) return jpeg_size(bytes);
  if (const auto netpbm = netpbm_of(bytes)) return Size{netpbm->width, netpbm->height};
  return std::nullopt;
}

/// How files of a format begin.
struct Beginning {
  std::size_t at = 0;
  std::string_view bytes, format;
};

}  // namespace

std::string problem_of_size(std::string_view bytes) {
  const std::optional<Size> size = size_in_header(bytes);
  if (!size || size->width * size->height <= kMostPixels) return {};
  return fmt::format("has {}x{} pixels; at most {} are read", size->width, size->height,
                     kMostPixels);
}

UnreadFormat unread_format(std::string_view bytes) {
  using namespace std::string_view_literals;
  constexpr std::uint32_t kDngVersion = 50706;
  if (bytes.starts_with("P7\n")) return {"PAM", true};  // exchanges red and blue
  if (is_tiff(bytes) && bytes.size() > 10 && bytes.substr(8, 2) == "CR")
    return {"CR2", true};  // takes the preview
  if (tiff_directory(bytes).entry(kDngVersion) != 0) return {"DNG", true};
  constexpr std::array<Beginning, 15> kUnread = {{{4, "ftyphei", "HEIF"},
                                                  {4, "ftypmif1", "HEIF"},
                                                  {4, "ftypmsf1", "HEIF"},
                                                  {4, "ftypavi", "AVIF"},
                                                  {4, "ftypcrx", "CR3"},
                                                  {0, "\xFF\x0A", "JPEG XL"},
                                                  {0, "\0\0\0\x0CJXL "sv, "JPEG XL"},
                                                  {0, "GIF8", "GIF"},
                                                  {0, "v/1\x01", "OpenEXR"},
                                                  {0, "8BPS", "PSD"},
                                                  {0, "DDS ", "DDS"},
                                                  {0, "\xABKTX", "KTX"},
                                                  {0, "%PDF", "PDF"},
                                                  {0, "<svg", "SVG"},
                                                  {0, "FUJIFILMCCD-RAW", "RAF"}}};
  for (const Beginning& one : kUnread)
    if (bytes.size() > one.at && bytes.substr(one.at).starts_with(one.bytes))
      return {one.format, false};
  return {};
}

}  // namespace hypotrack::internal
