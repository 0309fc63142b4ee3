#include "config/file_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <system_error>
#include <vector>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/files.hpp"
#include "hypotrack/api/text.hpp"

namespace hypotrack::detail::internal {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

/// Returns the references to the files of a folder that come with hypotrack.
std::vector<std::string> known_names(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(data_file("configs/" + folder), error))
    names.push_back(fmt::format("@{}/{}", folder, entry.path().stem().string()));
  std::ranges::sort(names);
  return names;
}

/// Returns the plural of a kind of file: `study` has `studies`.
std::string plural(std::string_view kind) {
  if (kind.ends_with('y')) return fmt::format("{}ies", kind.substr(0, kind.size() - 1));
  return fmt::format("{}s", kind);
}

}  // namespace

std::optional<FileName> file_name_in(const YamlNode& value) {
  if (value.kind != YamlNode::Kind::kScalar || !value.text.starts_with('@') ||
      value.text.starts_with("@@") || value.text.find('#') != std::string::npos)
    return std::nullopt;
  return FileName{value.text.substr(1), value.origin->directory, place_of(value)};
}

fs::path find_file(const FileName& name, std::string_view kind) {
  const fs::path file = name.is_path() ? name.text : name.text + ".yaml";
  fs::path beside = (name.directory / file).lexically_normal();
  if (is_file(beside)) return beside;
  std::string hint;
  if (!name.is_path()) {
    const std::vector<std::string> known = known_names(plural(kind));
    const std::string reference = "@" + name.text;
    if (std::ranges::find(known, reference) != known.end()) return data_file("configs" / file);
    const std::string nearest = did_you_mean(reference, known);
    hint = fmt::format("{} With hypotrack come {}", nearest.empty() ? "." : nearest,
                       fmt::join(known, ", "));
  }
  throw ConfigError(fmt::format("{}: there is no {} '@{}': {} is no file{}", name.where, kind,
                                name.text, beside.string(), hint));
}

}  // namespace hypotrack::detail::internal
