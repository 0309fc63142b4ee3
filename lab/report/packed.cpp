#include "lab/report/packed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/json_file.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::uint16_t kUnknown = 65535;

template <class T>
std::string pack(std::span<const T> values) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size() * sizeof(T));
  for (const T value : values)
    for (std::size_t k = 0; k < sizeof(T); ++k)
      bytes.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
  return base64(bytes);
}

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t block = 0;
    for (std::size_t k = 0; k < 3; ++k) block = block << 8 | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? kDigits[block >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string pack_bytes(std::span<const std::uint8_t> values) { return base64(values); }
std::string pack_words(std::span<const std::uint16_t> values) { return pack(values); }
std::string pack_longs(std::span<const std::uint32_t> values) { return pack(values); }

Json pack_numbers(std::span<const double> values) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  if (lowest > highest) lowest = highest = 0;
  const double step = (highest - lowest) / (kUnknown - 1);
  std::vector<std::uint16_t> words;
  words.reserve(values.size());
  for (const double value : values) {
    const double q = step > 0 ? std::round((value - lowest) / step) : 0;
    words.push_back(std::isfinite(value) ? static_cast<std::uint16_t>(q) : kUnknown);
  }
  return {{"b", pack_words(words)}, {"lo", lowest}, {"step", step}};
}

}  // namespace hypotrack::internal
