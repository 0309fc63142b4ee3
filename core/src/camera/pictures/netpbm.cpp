#include "camera/pictures/netpbm.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace hypotrack::internal {
namespace {

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Takes the next number of a header, behind spaces and comments.
std::optional<std::uint64_t> take_number(std::string_view& text) {
  constexpr std::size_t kMostDigits = 9;
  while (!text.empty() && (is_space(text[0]) || text[0] == '#'))
    text.remove_prefix(text[0] == '#' ? std::min(text.find('\n'), text.size()) : 1);
  std::uint64_t value = 0;
  std::size_t digits = 0;
  for (; digits < text.size() && is_digit(text[digits]) && digits <= kMostDigits; ++digits)
    value = 10 * value + static_cast<std::uint64_t>(text[digits] - '0');
  text.remove_prefix(digits);
  return digits > 0 && digits <= kMostDigits ? std::optional(value) : std::nullopt;
}

}  // namespace

std::optional<Netpbm> netpbm_of(std::string_view bytes) {
  constexpr std::string_view kKinds = "2356";
  constexpr std::uint64_t kMostWhite = 65535;
  if (bytes.size() < 3 || bytes[0] != 'P' || kKinds.find(bytes[1]) == kKinds.npos)
    return std::nullopt;
  Netpbm out{.kind = bytes[1]};
  if (!is_space(bytes[2]) && bytes[2] != '#') return std::nullopt;
  bytes.remove_prefix(2);
  const auto width = take_number(bytes), height = take_number(bytes), largest = take_number(bytes);
  if (!width || !height || !largest || *largest == 0 || *largest > kMostWhite) return std::nullopt;
  if (bytes.empty() || !is_space(bytes[0])) return std::nullopt;
  out.width = *width;
  out.height = *height;
  out.largest = static_cast<int>(*largest);
  out.pixels = bytes.substr(1);
  return out;
}

bool Netpbm::is_cut_off() const {
  const std::uint64_t bytes = (kind == '6' ? 3 : 1) * (largest > 255 ? 2 : 1);
  return (kind == '5' || kind == '6') && pixels.size() < width * height * bytes;
}

cv::Mat decode_netpbm(const Netpbm& header) {
  const bool wide = header.largest > 255, color = header.kind == '6';
  const std::uint64_t values = header.width * header.height * (color ? 3 : 1);
  if (values == 0 || header.is_cut_off()) return {};
  const int rows = static_cast<int>(header.height), columns = static_cast<int>(header.width);
  const int channels = color ? 3 : 1;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(header.pixels.data());
  cv::Mat out;
  if (wide) {
    out.create(rows, columns, CV_16UC(channels));
    auto* to = out.ptr<std::uint16_t>();
    for (std::uint64_t i = 0; i < values; ++i, bytes += 2)
      to[i] = static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]);
    if (color) cv::cvtColor(out, out, cv::COLOR_RGB2BGR);
    return out;
  }
  const cv::Mat stored(rows, columns, CV_8UC(channels), const_cast<std::uint8_t*>(bytes));
  if (color) {
    cv::cvtColor(stored, out, cv::COLOR_RGB2BGR);
  } else {
    out = stored.clone();
  }
  if (header.largest != 255) out.convertTo(out, -1, 255.0 / header.largest);
  return out;
}

}  // namespace hypotrack::internal
