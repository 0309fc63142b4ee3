#include "camera/formats/unused_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "hypotrack/api/text.hpp"

namespace hypotrack::calibration::internal {
namespace {

// A file of 8 MiB may have a million keys.
constexpr std::size_t kLargestMap = 4096;
constexpr std::size_t kMostNames = 1000;
constexpr std::size_t kShownNames = 24;

enum class Match { none, above, whole };

bool fits_part(std::string_view pattern, std::string_view name) {
  if (!pattern.ends_with('*')) return pattern == name;
  pattern.remove_suffix(1);
  return name.starts_with(pattern);
}

/// Compares a pattern with the parts of a path: `above` if the pattern goes on below the path.
Match match(std::string_view pattern, std::span<const std::string> path) {
  for (const std::string& name : path) {
    if (pattern.empty()) return Match::none;
    const std::size_t end = std::min(pattern.find('/'), pattern.size());
    const std::string_view part = pattern.substr(0, end);
    if (part == "**") return Match::whole;
    if (!fits_part(part, name)) return Match::none;
    pattern.remove_prefix(std::min(end + 1, pattern.size()));
  }
  return pattern.empty() || pattern == "**" ? Match::whole : Match::above;
}

Match best_match(const KeyPaths& patterns, std::span<const std::string> path) {
  Match best = Match::none;
  for (const std::string& pattern : patterns) best = std::max(best, match(pattern, path));
  return best;
}

/// Whether a pattern goes on below what another one names: a list of names and maps.
bool goes_below(const KeyPaths& patterns, std::span<const std::string> path) {
  return std::ranges::any_of(
      patterns, [&](const std::string& pattern) { return match(pattern, path) == Match::above; });
}

/// Collects the keys of a file that are not used.
class UnusedKeys {
 public:
  UnusedKeys(const KeyPaths& used, const std::vector<KnownButUnused>& unused)
      : used_(used), unused_(unused), names_(unused.size() + 1) {}

  void look_below(const ConfigNode& node) {
    if (node.is_map()) {
      const std::vector<std::string> keys = node.keys();
      if (keys.size() > kLargestMap)
        return add(unused_.size(), fmt::format("{} keys", keys.size()));
      for (const std::string& key : keys) look_at(key, node.get(key));
    } else {
      for (std::size_t i = 0; i < std::min(node.size(), kLargestMap); ++i)
        look_at(std::to_string(i), node.at(i));
    }
  }

  std::string note(const std::string& file_name) const {
    std::vector<std::string> parts;
    if (!names_.back().empty()) parts.push_back(unused_part(names_.back(), "not understood"));
    for (std::size_t i = 0; i < unused_.size(); ++i)
      if (!names_[i].empty()) parts.push_back(unused_part(names_[i], unused_[i].why));
    if (parts.empty()) return "";
    return fmt::format("{}: not used: {}", file_name, fmt::join(parts, "; "));
  }

 private:
  void look_at(const std::string& key, const ConfigNode& value) {
    path_.push_back(key);
    judge(value);
    path_.pop_back();
  }

  void judge(const ConfigNode& value) {
    if ((value.is_map() || value.is_list()) && goes_below(used_, path_)) return look_below(value);
    if (best_match(used_, path_) == Match::whole) return look_into_matrix(value);
    for (std::size_t i = 0; i < unused_.size(); ++i)
      if (best_match(unused_[i].paths, path_) != Match::none) return add(i, name());
    add(unused_.size(), name());
  }

  /// Names what a matrix of OpenCV has beside its numbers.
  void look_into_matrix(const ConfigNode& value) {
    constexpr std::array<std::string_view, 5> kParts = {"type_id", "rows", "cols", "dt", "data"};
    if (!value.is_map() || everything_below()) return;
    for (const std::string& key : value.keys())
      if (std::ranges::find(kParts, key) == kParts.end())
        add(unused_.size(), name() + "." + printable(key));
  }

  bool everything_below() const {
    return std::ranges::any_of(used_, [&](const std::string& pattern) {
      return pattern.ends_with("/**") && match(pattern, path_) == Match::whole;
    });
  }

  std::string name() const {
    std::string out;
    for (const std::string& part : path_) out += (out.empty() ? "" : ".") + printable(part);
    return out;
  }

  void add(std::size_t reason, std::string name) {
    if (names_[reason].size() < kMostNames) names_[reason].push_back(std::move(name));
  }

  const KeyPaths& used_;
  const std::vector<KnownButUnused>& unused_;
  std::vector<std::string> path_;
  std::vector<std::vector<std::string>> names_;  ///< by reason; the last are not understood
};

}  // namespace

void append_below(std::initializer_list<std::string_view> parts,
                  std::initializer_list<std::string_view> keys, KeyPaths& paths) {
  for (const std::string_view part : parts)
    for (const std::string_view key : keys) paths.push_back(fmt::format("{}/{}", part, key));
}

void append(const KeyPaths& paths, KeyPaths& to) {
  to.insert(to.end(), paths.begin(), paths.end());
}

KeyPaths size_keys(std::string_view prefix) {
  KeyPaths out;
  for (const char* key : {"image_width", "image_height", "image_Width", "image_Height", "imageSize",
                          "image_size", "resolution", "size"})
    out.push_back(fmt::format("{}{}", prefix, key));
  return out;
}

std::string unused_part(const std::vector<std::string>& names, std::string_view why) {
  const std::size_t shown = std::min(names.size(), kShownNames);
  std::string out = fmt::format("{}", fmt::join(std::span(names).first(shown), ", "));
  if (names.size() > shown) out += fmt::format(" and {} more", names.size() - shown);
  return fmt::format("{} ({})", out, why);
}

void note_unused_keys(const ConfigNode& file, const std::string& file_name, const KeyPaths& used,
                      const std::vector<KnownButUnused>& unused, std::vector<std::string>& notes) {
  UnusedKeys keys(used, unused);
  keys.look_below(file);
  if (std::string note = keys.note(file_name); !note.empty()) notes.push_back(std::move(note));
}

}  // namespace hypotrack::calibration::internal
