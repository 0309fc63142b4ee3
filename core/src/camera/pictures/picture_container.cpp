#include "camera/pictures/picture_container.hpp"

namespace hypotrack::internal {
namespace {

using Take = std::function<bool(std::string_view, std::string_view)>;

/// ITU-T T.81, B.1.1: segments up to the first scan.
void for_each_segment(std::string_view bytes, const Take& take) {
  constexpr std::uint32_t kScan = 0xDA, kEnd = 0xD9, kFill = 0xFF;
  const Numbers numbers(bytes, true);
  for (std::size_t at = 2; at + 4 <= bytes.size() && bytes[at] == '\xFF';) {
    const std::uint32_t marker = numbers.at(at + 1, 1);
    if (marker == kScan || marker == kEnd) return;
    if (marker == kFill) {
      ++at;
      continue;
    }
    const std::size_t size = numbers.at(at + 2, 2);
    if (size < 2 || !take(bytes.substr(at + 1, 1), bytes.substr(at + 4, size - 2))) return;
    at += 2 + size;
  }
}

/// Chunks of a PNG (big endian; 4 bytes of checksum follow) or of a WebP file.
void for_each_chunk(std::string_view bytes, bool png, const Take& take) {
  const Numbers numbers(bytes, png);
  for (std::size_t at = png ? 8 : 12; at + 8 <= bytes.size();) {
    const std::size_t size = numbers.at(png ? at : at + 4, 4);
    if (!take(bytes.substr(png ? at + 4 : at, 4), bytes.substr(at + 8, size))) return;
    at += 8 + size + (png ? 4 : size % 2);
  }
}

bool is_webp(std::string_view bytes) {
  return bytes.starts_with("RIFF") && bytes.size() > 12 && bytes.substr(8, 4) == "WEBP";
}

}  // namespace

std::uint32_t Numbers::at(std::size_t offset, std::size_t size) const {
  if (offset > bytes_.size() || bytes_.size() - offset < size) return 0;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t byte = offset + (big_endian_ ? i : size - 1 - i);
    value = value << 8 | static_cast<unsigned char>(bytes_[byte]);
  }
  return value;
}

void for_each_part(std::string_view bytes, const Take& take) {
  if (bytes.starts_with("\xFF\xD8\xFF")) for_each_segment(bytes, take);
  if (bytes.starts_with("\x89PNG\r\n")) for_each_chunk(bytes, true, take);
  if (is_webp(bytes)) for_each_chunk(bytes, false, take);
}

bool is_tiff(std::string_view bytes) {
  using namespace std::string_view_literals;
  return bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv);
}

TiffDirectory tiff_directory(std::string_view bytes, std::size_t place) {
  TiffDirectory out{{bytes, bytes.starts_with('M')}, place};
  if (!is_tiff(bytes)) return out;
  if (place == 0) out.place = out.numbers.at(4, 4);
  out.is_inside = out.place > 0 && out.place < bytes.size();
  if (out.is_inside) out.entries = out.numbers.at(out.place, 2);
  return out;
}

std::size_t TiffDirectory::entry(std::uint32_t tag) const {
  constexpr std::size_t kSize = 12;
  for (std::size_t i = 0; i < entries; ++i)
    if (const std::size_t at = place + 2 + kSize * i; numbers.at(at, 2) == tag) return at;
  return 0;
}

std::uint32_t TiffDirectory::value(std::uint32_t tag) const {
  constexpr std::uint32_t kShort = 3;
  const std::size_t at = entry(tag);
  return at == 0 ? 0 : numbers.at(at + 8, numbers.at(at + 2, 2) == kShort ? 2 : 4);
}

std::size_t TiffDirectory::next() const { return numbers.at(place + 2 + 12 * entries, 4); }

}  // namespace hypotrack::internal
