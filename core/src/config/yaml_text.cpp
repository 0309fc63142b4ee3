#include "config/yaml_text.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <system_error>
#include <thread>

#include "base/descriptor.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::detail::internal {
namespace {

/// Returns the length of the UTF-8 sequence at the start of `rest`, 0 if it is invalid.
std::size_t utf8_length(std::string_view rest) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(rest[i]); };
  if (byte(0) < 0x80) return 1;
  const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || rest.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  const bool overlong = (byte(0) == 0xE0 && byte(1) < 0xA0) || (byte(0) == 0xF0 && byte(1) < 0x90);
  const bool outside = (byte(0) == 0xED && byte(1) > 0x9F) || (byte(0) == 0xF4 && byte(1) > 0x8F);
  return overlong || outside ? 0 : length;
}

/// Returns true for the 66 code points that Unicode keeps free of characters: a valid sequence of
/// `length` bytes.
bool is_noncharacter(std::string_view rest, std::size_t length) {
  if (length < 3) return false;
  std::uint32_t point = static_cast<unsigned char>(rest[0]) & (length == 3 ? 0x0Fu : 0x07u);
  for (std::size_t i = 1; i < length; ++i) {
    point = point << 6 | (static_cast<unsigned char>(rest[i]) & 0x3Fu);
  }
  return (point & 0xFFFE) == 0xFFFE || (point >= 0xFDD0 && point <= 0xFDEF);
}

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7F;
}

/// Reads a named pipe. Throws ConfigError if nobody begins to write into it.
std::string read_pipe(const std::filesystem::path& file) {
  constexpr std::chrono::milliseconds kPatience{2000}, kInterval{10};
  // Without O_NONBLOCK, open() waits for a writer for ever.
  const int opened = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (opened < 0)
    throw ConfigError(fmt::format("{}: cannot be opened: {}", file.string(),
                                  std::generic_category().message(errno)));
  const Descriptor pipe(opened);
  std::string text;
  std::array<char, 4096> buffer;
  bool has_writer = false;
  const auto begin = std::chrono::steady_clock::now();
  while (text.size() <= kMaxYamlBytes) {
    const ssize_t size = ::read(pipe.get(), buffer.data(), buffer.size());
    if (size > 0) text.append(buffer.data(), static_cast<std::size_t>(size));
    has_writer = has_writer || size != 0;
    if (size > 0) continue;
    if (size < 0 && errno != EAGAIN && errno != EINTR)
      throw ConfigError(file.string() + ": cannot be read");
    if (size == 0 && has_writer) break;  // the writer has gone
    if (size == 0 && std::chrono::steady_clock::now() - begin > kPatience)
      throw ConfigError(file.string() +
                        ": is a pipe that nobody writes into; expected a YAML file");
    std::this_thread::sleep_for(kInterval);
  }
  return text;
}

}  // namespace

bool is_text(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0 || is_noncharacter(text, length)) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string read_text_file(const std::filesystem::path& file) {
  if (file.empty()) throw ConfigError("the name of the file is empty; expected a YAML file");
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) {
    throw ConfigError(file.string() + ": is a folder; expected a YAML file");
  }
  if (std::filesystem::is_fifo(file, ignored)) return read_pipe(file);
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw ConfigError(fmt::format("{}: cannot be opened: {}", file.string(),
                                  std::generic_category().message(errno)));
  }
  std::string text;
  std::array<char, 1 << 15> block;
  while (in && text.size() <= kMaxYamlBytes + 3) {  // so much tells a file that is too large
    in.read(block.data(), block.size());
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) throw ConfigError(file.string() + ": cannot be read");
  return text;
}

YamlText::YamlText(std::string_view text, const YamlOrigin& origin) : text_(text) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  if (text_.size() > kMaxYamlBytes) {
    throw ConfigError(fmt::format("{}: is larger than {} MiB, which no scene needs", origin.name,
                                  kMaxYamlBytes >> 20));
  }
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i) {
    if (text_[i] == '\n') line_starts_.push_back(i + 1);
  }
  check(origin);
}

YamlText::Position YamlText::position(int line, int byte) const {
  const auto index = std::min(static_cast<std::size_t>(std::max(line, 0)), line_starts_.size() - 1);
  const auto end = static_cast<std::size_t>(std::max(byte, 0));
  if (index != known_line_ || end < known_byte_) {
    known_line_ = index;
    known_byte_ = 0;
    known_characters_ = 0;
  }
  const std::string_view next =
      from(static_cast<int>(index), static_cast<int>(known_byte_)).substr(0, end - known_byte_);
  known_characters_ += static_cast<std::size_t>(std::count_if(next.begin(), next.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
  known_byte_ = end;
  return {static_cast<int>(index) + 1, static_cast<int>(known_characters_) + 1};
}

std::string_view YamlText::from(int line, int byte) const {
  const auto index = std::min(static_cast<std::size_t>(std::max(line, 0)), line_starts_.size() - 1);
  const auto begin = line_starts_[index] + static_cast<std::size_t>(std::max(byte, 0));
  return text_.substr(std::min(begin, text_.size()));
}

void YamlText::check(const YamlOrigin& origin) const {
  std::size_t line = 0;
  for (std::size_t i = 0; i < text_.size();) {
    if (line + 1 < line_starts_.size() && i >= line_starts_[line + 1]) ++line;
    const std::string_view rest = text_.substr(i);
    const std::size_t length = utf8_length(rest);
    const bool is_free = is_noncharacter(rest, length);
    if (length == 0 || is_free || is_control(rest[0])) {
      const Position at =
          position(static_cast<int>(line), static_cast<int>(i - line_starts_[line]));
      const char* found = length == 0 ? "no UTF-8: found byte"
                          : is_free   ? "found the bytes of no character, from"
                                      : "found the control character";
      throw ConfigError(fmt::format("{}: {} 0x{:02X}; expected UTF-8 text",
                                    describe_position(origin, at.line, at.column), found,
                                    static_cast<unsigned char>(rest[0])));
    }
    i += length;
  }
}

}  // namespace hypotrack::detail::internal
