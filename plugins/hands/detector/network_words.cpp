#include "network_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace hypotrack::hands {

std::string shown(std::string_view word) {
  constexpr std::size_t kLongest = 20;
  const bool is_text = std::ranges::all_of(word, [](char c) { return c > ' ' && c <= '~'; });
  return is_text ? "'" + std::string(word.substr(0, kLongest)) + "'" : "a word";
}

std::string_view Words::take() {
  const std::size_t end = std::min(rest_.find(' '), rest_.size());
  const std::string_view word = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  if (word.empty()) throw Damage("a word is missing");
  return word;
}

int Words::take_number(int low, int high) {
  const std::string_view word = take();
  int out = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), out);
  if (error != std::errc() || end != word.data() + word.size() || out < low || out > high)
    throw Damage(fmt::format("{} is not a number from {} to {}", shown(word), low, high));
  return out;
}

}  // namespace hypotrack::hands
