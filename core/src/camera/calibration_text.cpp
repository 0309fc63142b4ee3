#include "camera/calibration_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "base/file_bytes.hpp"
#include "camera/formats/zed_sections.hpp"
#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"

namespace hypotrack::internal {
namespace {

constexpr std::size_t kLargestYamlFile = std::size_t{8} << 20;

std::string read_text(const std::filesystem::path& file) {
  if (const std::string why = why_no_file(file); !why.empty()) {
    throw DataError(fmt::format("{}: {}; expected a calibration", file.string(), why));
  }
  std::error_code error;
  if (std::filesystem::file_size(file, error) > kLargestYamlFile || error) {
    throw DataError(
        fmt::format("{}: is larger than 8 MiB, which no calibration is", file.string()));
  }
  std::optional<std::string> text = read_whole(file);
  if (!text)
    throw DataError(fmt::format("{}: cannot be read; check its permissions", file.string()));
  if (text->starts_with("MATLAB "))
    throw DataError(
        fmt::format("{}: is a file of MATLAB, which is not read; write M1, D1, M2, D2, R and T of "
                    "OpenCV as YAML. MATLAB's stereoParametersToOpenCV gives them",
                    file.string()));
  return std::move(*text);
}

enum class Language { yaml, json, toml, unknown };

/// Returns the language of a text by its first line that is no comment.
Language language_of(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n", kMark = "\xEF\xBB\xBF";
  if (text.starts_with("\x1F\x8B")) return Language::unknown;
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
    if (!text.starts_with('#')) break;
    text.remove_prefix(std::min(text.find('\n'), text.size()));
  }
  const std::string_view line = text.substr(0, text.find('\n'));
  if (line.starts_with('<')) return Language::unknown;
  if (line.starts_with('{')) return Language::json;
  if (line.starts_with('[')) return Language::toml;
  const std::size_t equals = line.find('='), colon = line.find(':');
  return equals < colon ? Language::toml : Language::yaml;
}

/// Puts the space after the colon of a key that OpenCV lets out: `data:[1, 2]`. Lines stay where
/// they are.
std::string separate_keys(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t newline = std::min(text.find('\n'), text.size() - 1);
    const std::string_view line = text.substr(0, newline + 1);
    text.remove_prefix(line.size());
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    std::size_t end = begin;
    while (end < line.size() && (std::isalnum(static_cast<unsigned char>(line[end])) ||
                                 line[end] == '_' || line[end] == '.'))
      ++end;
    const bool is_key = end > begin && !std::isdigit(static_cast<unsigned char>(line[begin])) &&
                        end + 1 < line.size() && line[end] == ':' &&
                        !std::isspace(static_cast<unsigned char>(line[end + 1]));
    out += is_key ? line.substr(0, end + 1) : line;
    if (is_key) out += ' ';
    if (is_key) out += line.substr(end + 1);
  }
  return out;
}

/// Blanks OpenCV's deviations from YAML 1.2 and keeps all lines.
void blank_opencv_marks(std::string& text) {
  const std::size_t start = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  if (text.compare(start, 8, "%YAML:1.") == 0) text = separate_keys(text);
  if (text.compare(start, 5, "%YAML") == 0) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(start),
              text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  }
  constexpr std::string_view kTag = "!!opencv-matrix";
  for (std::size_t at = text.find(kTag); at != std::string::npos; at = text.find(kTag, at)) {
    text.replace(at, kTag.size(), kTag.size(), ' ');
  }
}

/// Returns whether a part of a YAML text has comments, directives and ends of documents only.
bool says_nothing(std::string_view part) {
  while (!part.empty()) {
    const std::size_t end = std::min(part.find('\n'), part.size());
    std::string_view line = part.substr(0, end);
    part.remove_prefix(std::min(end + 1, part.size()));
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
    const bool nothing =
        line.empty() || line.starts_with('#') || line.starts_with('%') || line.starts_with("...");
    if (!nothing) return false;
  }
  return true;
}

/// Returns the documents of a YAML text, without their `---`, and without empty ones.
std::vector<std::string_view> documents_of(std::string_view text) {
  std::vector<std::string_view> out;
  std::size_t begin = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  const auto end_at = [&](std::size_t end) {
    const std::string_view document = text.substr(begin, end - begin);
    if (!says_nothing(document)) out.push_back(document);
  };
  for (std::size_t line = begin; line < text.size();) {
    const std::string_view rest = text.substr(line);
    if (rest.starts_with("---") &&
        (rest.size() == 3 || std::isspace(static_cast<unsigned char>(rest[3])))) {
      end_at(line);
      begin = line + 3;
    }
    line += std::min(rest.find('\n'), rest.size() - 1) + 1;
  }
  end_at(text.size());
  return out;
}

/// Returns what a document says, but for the header of a message of ROS.
std::string content_of(const ConfigNode& document) {
  std::string out;
  for (const std::string& key : document.keys())
    if (key != "header") out += fmt::format("{}:\n{}", key, document.get(key).to_yaml());
  return out;
}

/// Reads the only document of a text, or the first of equal ones: `ros2 topic echo` writes one for
/// each message, with `---` after it.
ConfigNode parse_yaml(std::string text, const std::filesystem::path& file) {
  const std::vector<std::string_view> documents = documents_of(text);
  const auto parse = [&](std::string_view document, std::string name) {
    return ConfigNode::parse(document, std::move(name), file.parent_path());
  };
  if (documents.empty()) return parse(text, file.string());
  const auto begin = static_cast<std::size_t>(documents[0].data() - text.data());
  // Blanks instead of what stands before it keep all positions.
  std::replace_if(
      text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin),
      [](char c) { return c != '\n'; }, ' ');
  ConfigNode first =
      parse(std::string_view(text).substr(0, begin + documents[0].size()), file.string());
  const std::string content = documents.size() > 1 ? content_of(first) : "";
  for (std::size_t i = 1; i < documents.size(); ++i) {
    if (documents[i] == documents[0]) continue;
    const char* const start = documents[i].data();
    const auto line = 1 + std::count(std::as_const(text).data(), start, '\n');
    const ConfigNode other =
        parse(documents[i], fmt::format("{}: document from line {}", file.string(), line));
    if (content_of(other) == content && !content.empty()) continue;
    throw DataError(
        fmt::format("{}:{}: a YAML document begins that differs from the first; expected one "
                    "document, or equal ones. Write the camera_info of each camera into a file of "
                    "its own",
                    file.string(), line));
  }
  return first;
}

}  // namespace

ConfigNode read_calibration_text(const std::filesystem::path& file) {
  std::string text = read_text(file);
  try {
    if (calibration::is_zed_text(text))
      return ConfigNode::parse_toml(calibration::zed_as_toml(text), file.string());
    if (is_opencv_xml(text))
      return ConfigNode::parse(opencv_xml_as_json(text, file.string()),
                               file.string() + ": converted from XML");
    switch (language_of(text)) {
      case Language::toml:
        return ConfigNode::parse_toml(text, file.string());
      case Language::json:
        std::ranges::replace(text, '\t', ' ');
        break;
      case Language::yaml:
        blank_opencv_marks(text);
        return parse_yaml(std::move(text), file);
      case Language::unknown:
        throw DataError(fmt::format(
            "{}: is XML or compressed, and has no <opencv_storage>; expected YAML, JSON or XML of "
            "cv::FileStorage, or TOML. Metashape and others export OpenCV's form, too",
            file.string()));
    }
    return ConfigNode::parse(text, file.string(), file.parent_path());
  } catch (const ConfigError& e) {
    throw DataError(e.what());
  }
}

}  // namespace hypotrack::internal
