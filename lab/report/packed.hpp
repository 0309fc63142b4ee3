#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/exported.hpp"

// Packs numbers as short text for the page: little-endian bytes in base64. decode.js reads them.

namespace hypotrack {
inline namespace HYPOTRACK_EXPORTED internal {

/// Returns a number as JSON; null if it is not finite.
inline nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

std::string base64(std::span<const std::uint8_t> bytes);

/// Packs integers, little-endian, in base64.
std::string pack_bytes(std::span<const std::uint8_t> values);
std::string pack_words(std::span<const std::uint16_t> values);
std::string pack_longs(std::span<const std::uint32_t> values);

/// Packs numbers as {b, lo, step}: each value is lo + step * q with q of 16 bits; q = 65535 is
/// unknown (NaN or infinite). The error is at most half a step, (max - min) / 65534 / 2.
nlohmann::ordered_json pack_numbers(std::span<const double> values);

}  // namespace internal
}  // namespace hypotrack
