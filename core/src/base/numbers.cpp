#include "base/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace hypotrack::detail::internal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t skip_digits(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  const auto count = static_cast<std::size_t>(end - text.begin());
  text.remove_prefix(count);
  return count;
}

std::string_view without_plus(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return text;
}

/// Matches [digits][.digits][e[sign]digits] with at least one digit before the exponent.
bool is_unsigned_decimal(std::string_view text) {
  std::size_t digits = skip_digits(text);
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    digits += skip_digits(text);
  }
  if (digits == 0) return false;
  if (text.empty()) return true;
  if (text.front() != 'e' && text.front() != 'E') return false;
  text.remove_prefix(1);
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  return skip_digits(text) > 0 && text.empty();
}

std::string_view without_sign(std::string_view text) {
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  return text;
}

template <class T>
std::optional<T> convert(std::string_view text) {
  text = without_plus(text);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::size_t significant_digits(std::string_view text) {
  std::size_t count = 0;
  for (const char c : text) {
    if (c == 'e' || c == 'E') break;
    if (is_digit(c) && (count > 0 || c != '0')) ++count;
  }
  return count;
}

bool same_bits(double a, double b) { return a == b && std::signbit(a) == std::signbit(b); }

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const std::string_view magnitude = without_sign(text);
  const bool negative = text.starts_with('-');
  if (magnitude == ".inf" || magnitude == ".Inf" || magnitude == ".INF") {
    return negative ? -kInfinity : kInfinity;
  }
  if (text == ".nan" || text == ".NaN" || text == ".NAN") {
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (!is_unsigned_decimal(magnitude)) return std::nullopt;
  return convert<double>(text);
}

std::optional<std::int64_t> parse_integer(std::string_view text) {
  const auto number = parse_number(text);
  if (!number) return std::nullopt;
  if (const auto exact = convert<std::int64_t>(text)) return exact;
  // Beyond 2^53 not every integer is a double; only the plain form above is exact there.
  const bool exact = std::abs(*number) <= 9007199254740992.0 && *number == std::trunc(*number);
  if (!exact) return std::nullopt;
  return static_cast<std::int64_t>(*number);
}

double scale_number(std::string_view text, double number, double to_si) {
  if (to_si == 1.0) return number;
  if (std::isfinite(number) && significant_digits(text) > 17) {
    if (const auto wide = convert<long double>(text)) {
      return static_cast<double>(*wide * static_cast<long double>(to_si));
    }
  }
  return number * to_si;
}

std::string format_number(double value, double to_si) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  if (to_si == 1.0 || value == 0.0) return fmt::format("{}", value);
  const double quotient = value / to_si;
  for (int digits = 1; digits <= 17; ++digits) {
    const auto rounded = parse_number(fmt::format("{:.{}g}", quotient, digits));
    if (rounded && same_bits(*rounded * to_si, value)) return fmt::format("{}", *rounded);
  }
  const double neighbours[] = {std::nextafter(quotient, kInfinity),
                               std::nextafter(quotient, -kInfinity)};
  for (const double neighbour : neighbours) {
    if (same_bits(neighbour * to_si, value)) return fmt::format("{}", neighbour);
  }
  const long double wide = static_cast<long double>(value) / static_cast<long double>(to_si);
  return fmt::format("{:.20e}", wide);
}

std::string describe_range(double min, double max, std::string_view unit) {
  const std::string suffix = unit.empty() ? "" : fmt::format(" {}", unit);
  if (min == -kInfinity && max == kInfinity) return "";
  if (max == kInfinity) return fmt::format("at least {}{}", min, suffix);
  if (min == -kInfinity) return fmt::format("at most {}{}", max, suffix);
  return fmt::format("from {} to {}{}", min, max, suffix);
}

}  // namespace hypotrack::detail::internal
