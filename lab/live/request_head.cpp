#include "lab/live/request_head.hpp"

#include <strings.h>

#include <algorithm>
#include <array>

namespace hypotrack::internal {
namespace {

constexpr std::array<std::string_view, 8> kUsed = {
    "Host",          "Origin", "Sec-Fetch-Site", "Sec-Fetch-Mode",
    "Authorization", "Cookie", "Content-Length", "Transfer-Encoding"};

bool is_used(std::string_view line) {
  const std::string_view name = line.substr(0, line.find(':'));
  return std::ranges::any_of(kUsed, [&](std::string_view used) {
    return used.size() == name.size() && strncasecmp(used.data(), name.data(), name.size()) == 0;
  });
}

}  // namespace

std::string used_head(std::string_view head) {
  constexpr std::string_view kEnd = "\r\n";
  std::string used;
  for (bool first = true; !head.empty(); first = false) {
    const std::size_t end = std::min(head.find(kEnd), head.size());
    const std::string_view line = head.substr(0, end);
    if (first || is_used(line)) (used += line) += kEnd;
    head.remove_prefix(std::min(end + kEnd.size(), head.size()));
  }
  return used += kEnd;
}

}  // namespace hypotrack::internal
