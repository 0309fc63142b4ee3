#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "hypotrack/api/text.hpp"

namespace hypotrack {
namespace {

/// Longest word to compare. Longer ones are not typing errors, and the cost is the product of both
/// lengths.
constexpr std::size_t kLongestWord = 64;

int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t width = b.size() + 1;
  std::vector<int> table((a.size() + 1) * width);
  const auto at = [&](std::size_t i, std::size_t j) -> int& { return table[i * width + j]; };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : 1;
      at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
      }
    }
  }
  return at(a.size(), b.size());
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
  if (word.empty() || word.size() > kLongestWord) return "";
  // Allow one error per three letters; words of two letters resemble anything.
  int nearest = std::max(1, static_cast<int>(word.size()) / 3) + 1;
  std::size_t added = 0;  // letters that the nearest has more or less
  const std::string* best = nullptr;
  for (const std::string& candidate : candidates) {
    if (candidate.empty() || candidate.size() > kLongestWord) continue;
    const bool starts =
        word.size() >= 3 && (candidate.starts_with(word) || word.starts_with(candidate));
    const int distance = starts ? 1 : edit_distance(word, candidate);
    const std::size_t more =
        std::max(candidate.size(), word.size()) - std::min(candidate.size(), word.size());
    if (std::pair(distance, more) < std::pair(nearest, added) &&
        distance < static_cast<int>(candidate.size())) {
      nearest = distance;
      added = more;
      best = &candidate;
    }
  }
  return best ? fmt::format("; did you mean '{}'?", *best) : "";
}

}  // namespace hypotrack
