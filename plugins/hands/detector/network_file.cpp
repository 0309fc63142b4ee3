#include "network_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "network_builder.hpp"

namespace hypotrack::hands {
namespace {

constexpr std::string_view kFirstLine = "hypotrack network 1";

/// Returns the bytes of a file that is no larger than expected.
std::string read_bytes(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    const bool is_old =
        std::filesystem::exists(std::filesystem::path(file).replace_extension("onnx"), error);
    throw DataError(fmt::format(
        "{}: the hand detector needs this file{}; run `hypotrack get detector`", file.string(),
        is_old ? ", and its folder has those of an earlier version" : ""));
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kLargestNetworkFile) fail_damaged(file, "it is too large");
  std::string out(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(out.data(), static_cast<std::streamsize>(size)))
    fail_damaged(file, "it cannot be read");
  return out;
}

/// Returns the weights in the bytes behind the head.
std::vector<float> weights_in(std::string_view bytes, std::size_t count) {
  if (bytes.size() != count * sizeof(float))
    throw Damage(
        fmt::format("{} bytes follow the head, expected {}", bytes.size(), count * sizeof(float)));
  std::vector<float> out(count);
  std::memcpy(out.data(), bytes.data(), bytes.size());
  if (!std::ranges::all_of(out, [](float x) { return std::isfinite(x); }))
    throw Damage("a weight is not finite");
  return out;
}

}  // namespace

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

std::size_t NetworkGraph::size(const NetworkOutput& output) const {
  std::size_t out = 0;
  for (const int tensor : output.tensors)
    out += tensors.at(static_cast<std::size_t>(tensor)).size();
  return out;
}

NetworkGraph read_network(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  std::string_view rest = bytes;
  GraphBuilder builder;
  for (int line = 1;; ++line) {
    const std::size_t end = rest.find('\n');
    try {
      if (line == 1 && rest.substr(0, end) != kFirstLine)
        throw Damage("it does not begin with '" + std::string(kFirstLine) + "'");
      if (end == std::string_view::npos) throw Damage("the file ends there");
      const std::string_view text = rest.substr(0, end);
      rest.remove_prefix(end + 1);
      if (line == 1) continue;
      if (const std::optional<std::size_t> count = builder.add_line(text)) {
        builder.graph.weights = weights_in(rest, *count);
        return std::move(builder.graph);
      }
    } catch (const Damage& damage) {
      fail_damaged(file, fmt::format("line {}: {}", line, damage.what()));
    }
  }
}

void fail_damaged(const std::filesystem::path& file, const std::string& reason) {
  throw DataError(
      fmt::format("{}: the hand detector's network is damaged ({}); run `hypotrack get detector`",
                  file.string(), reason));
}

}  // namespace hypotrack::hands
