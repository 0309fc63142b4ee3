#include "urdf_text.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cctype>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack::articulated {
namespace {

// The parser nests a call per element: deep files would exhaust the stack.
constexpr std::ptrdiff_t kMostElements = 10'000;
constexpr std::uintmax_t kLargestFile = std::uintmax_t{4} << 20;

/// Collects what urdfdom logs instead of printing it. One at a time: the log is the process'.
class Log final : public console_bridge::OutputHandler {
 public:
  Log() : lock_(mutex_) { console_bridge::useOutputHandler(this); }
  ~Log() override { console_bridge::restorePreviousOutputHandler(); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    constexpr std::size_t kLongest = 500;
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_WARN || text_.size() > kLongest) return;
    if (text_.find(text) != std::string::npos) return;
    text_ += (text_.empty() ? "" : "; ") + text.substr(0, kLongest);
  }
  const std::string& text() const { return text_; }

 private:
  inline static std::mutex mutex_;
  std::lock_guard<std::mutex> lock_;
  std::string text_;
};

/// Returns the message of newer parsers in the words of older ones, "Error=XML_ERROR_PARSING
/// ErrorID=6 (0x6) Line number=3: ..." as "Error reading line 3: parsing: ...".
std::string plain_error(const std::string& log) {
  constexpr std::string_view kError = "Error=XML_ERROR_", kLine = "Line number=";
  const std::size_t line = log.find(kLine);
  if (!log.starts_with(kError) || line == log.npos) return log;
  std::string kind = log.substr(kError.size(), log.find(' ') - kError.size());
  std::ranges::transform(kind, kind.begin(), [](unsigned char c) {
    return c == '_' ? ' ' : static_cast<char>(std::tolower(c));
  });
  const std::string rest = log.substr(line + kLine.size());
  const std::size_t colon = std::min(rest.find(':'), rest.size());
  return fmt::format("Error reading line {}: {}{}", rest.substr(0, colon), kind,
                     rest.substr(colon));
}

/// Returns a text for messages: one line without control characters.
std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  while (text.ends_with('.') || text.ends_with(' ')) text.pop_back();
  return text;
}

std::string read(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw DataError(
        fmt::format("{}: there is no such file{}", file.string(),
                    std::filesystem::is_directory(file, error) ? ", it is a folder" : ""));
  if (std::filesystem::file_size(file, error) > kLargestFile)
    throw DataError(fmt::format("{}: this is no URDF file of an object: it is larger than {} MiB",
                                file.string(), kLargestFile >> 20));
  std::optional<std::string> text = read_whole(file);
  if (!text) throw DataError(fmt::format("{}: cannot be read", file.string()));
  if (text->starts_with("\xFF\xFE") || text->starts_with("\xFE\xFF"))
    throw DataError(fmt::format("{}: the file is in UTF-16; write it in UTF-8", file.string()));
  if (const auto elements = std::ranges::count(*text, '<'); elements > 2 * kMostElements)
    throw DataError(fmt::format("{}: the file has more than {} elements; expected one object",
                                file.string(), kMostElements));
  return std::move(*text);
}

/// Returns the place behind the next `end` from `begin` on, or that of the text's end.
std::size_t behind(std::string_view text, std::string_view end, std::size_t begin) {
  const std::size_t at = text.find(end, begin);
  return at == text.npos ? text.size() : at + end.size();
}

bool is_element(std::string_view rest, std::string_view begin) {
  return rest.starts_with(begin) && rest.size() > begin.size() &&
         std::string_view(" \t\r\n/>").find(rest[begin.size()]) != rest.npos;
}

/// Returns the element that a text begins with if it describes no shape and no joint; empty if the
/// text begins with another. The parser refuses some that are incomplete.
std::string_view unused_element(std::string_view text) {
  for (const std::string_view name :
       {"collision", "inertial", "gazebo", "transmission", "safety_controller", "dynamics",
        "calibration", "sensor", "ros2_control"})
    if (text.starts_with('<') && is_element(text.substr(1), name)) return name;
  return {};
}

/// Returns the place behind the tag that a text begins with. Values of attributes may have a `>`.
std::size_t behind_tag(std::string_view text) {
  char quote = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (quote == 0 && c == '>') return at + 1;
    if (quote == 0 && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    }
  }
  return text.size();
}

/// Returns the place behind the element of a name that a text begins with.
std::size_t behind_element(std::string_view text, std::string_view name) {
  const std::size_t begin = behind_tag(text);
  if (text[begin - 2] == '/') return begin;
  const std::string end = fmt::format("/{}", name);
  for (std::size_t at = begin; (at = text.find('<', at)) != text.npos; ++at) {
    if (text.substr(at).starts_with("<!--")) at = behind(text, "-->", at + 4) - 1;
    if (is_element(text.substr(at + 1), end)) return behind(text, ">", at);
  }
  return text.size();
}

/// Returns a URDF text without comments and unused elements. Limits of joints get the effort and
/// velocity that the specification asks for and many files leave out. Lines keep their numbers.
std::string text_for_parser(std::string_view text) {
  std::string out;
  const auto leave_out = [&](std::size_t size) {
    const auto lines = std::ranges::count(text.substr(0, size), '\n');
    out.append(static_cast<std::size_t>(lines), '\n');
    text.remove_prefix(size);
  };
  while (!text.empty()) {
    if (text.starts_with("<!--")) {
      leave_out(behind(text, "-->", 4));
    } else if (const std::string_view unused = unused_element(text); !unused.empty()) {
      leave_out(behind_element(text, unused));
    } else if (is_element(text, "<limit")) {
      constexpr std::string_view kLimit = "<limit";
      const std::string_view inside = text.substr(0, behind(text, ">", 0));
      out += kLimit;
      if (inside.find("effort") == inside.npos) out += " effort='0'";
      if (inside.find("velocity") == inside.npos) out += " velocity='0'";
      text.remove_prefix(kLimit.size());
    } else {
      const std::size_t end = std::min(text.find('<', 1), text.size());
      out += text.substr(0, end);
      text.remove_prefix(end);
    }
  }
  return out;
}

}  // namespace

urdf::ModelInterfaceSharedPtr parse_urdf(const std::filesystem::path& file,
                                         std::vector<std::string>& notes) {
  const std::string whole = read(file);
  const std::string text = text_for_parser(whole);
  const Log log;
  urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
  if (model && log.text().empty()) {
    for (const std::string& note : unread_in_urdf(whole))
      notes.push_back(fmt::format("{}: {}", file.string(), note));
    return model;
  }
  std::string hint;
  if (text.find("xacro:") != std::string::npos)
    hint = "; this is a xacro macro file: write the URDF that `xacro` makes of it";
  else if (log.text().find("Unknown geometry type") != std::string::npos)
    hint =
        "; a <geometry> is a <box>, <cylinder>, <sphere> or <mesh>: make a capsule of a cylinder "
        "and two spheres, in a <visual> each, or of a mesh";
  throw DataError(fmt::format(
      "{}: this is no valid URDF file: {}{}", file.string(),
      log.text().empty() ? "urdfdom does not read it" : one_line(plain_error(log.text())), hint));
}

}  // namespace hypotrack::articulated
