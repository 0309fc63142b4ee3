#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "config/file_name.hpp"
#include "config/includes.hpp"
#include "config/overrides.hpp"
#include "config/yaml.hpp"
#include "hypotrack/api/error.hpp"

namespace hypotrack::detail::internal {
namespace {

namespace fs = std::filesystem;

/// Keys that an override replaces. What is left belongs to the recording or the machine.
constexpr std::array<std::string_view, 12> kKeysOfTrackers{
    "objective", "optimizer", "budget", "tile",     "photometric", "search",
    "judge",     "tracker",   "status", "recovery", "uncertainty", "smoothing"};

/// Returns the reference that a value of the key `tracker` is or has at `from`.
std::optional<FileName> name_in(const YamlNode& value) {
  const YamlNode* node = &value;
  if (value.kind == YamlNode::Kind::kMap) {
    const YamlNode::Entry* from = value.find("from");
    if (!from) return std::nullopt;
    node = from->value.get();
  }
  return file_name_in(*node);
}

/// Reads a tracker file. Returns null if it is a scene.
const YamlNode* read(const FileName& name, Includes& includes) {
  const fs::path file = find_file(name, "tracker");
  try {
    const YamlNode& tracker = includes.document(file);
    const bool is_map = tracker.kind == YamlNode::Kind::kMap;
    if (is_map && tracker.find("models") && name.is_path()) return nullptr;
    for (const char* key : {"models", "source", "scenes"})
      if (!is_map || tracker.find(key))
        throw ConfigError(fmt::format(
            "{} is no tracker; expected a map with the objective, the optimizer and their "
            "settings, without models and source",
            file.string()));
    return &tracker;
  } catch (const ConfigError& error) {
    throw ConfigError(
        fmt::format("{}: the tracker '@{}': {}", name.where, name.text, error.what()));
  }
}

/// Adds what `own` lacks. A map with a `type` is a whole, whose keys only that type knows.
void join(YamlNode& own, const YamlNode& tracker) {
  for (const YamlNode::Entry& entry : tracker.entries) {
    const YamlNode::Entry* there = own.find(entry.key);
    if (!there)
      own.add(entry.key, clone(*entry.value));
    else if (there->value->kind == YamlNode::Kind::kMap &&
             entry.value->kind == YamlNode::Kind::kMap && !there->value->find("type"))
      join(*there->value, *entry.value);
  }
}

void remove(YamlNode& map, std::string_view key) {
  std::erase_if(map.entries, [&](const YamlNode::Entry& entry) { return entry.key == key; });
}

/// Returns the value of an override of the key `tracker`; null for others and for broken YAML,
/// which is reported where overrides are applied.
std::unique_ptr<YamlNode> tracker_value(const std::string& assignment) {
  constexpr std::string_view kKey = "tracker=";
  if (!assignment.starts_with(kKey)) return nullptr;
  auto origin = std::make_shared<YamlOrigin>();
  origin->name = "--set " + assignment;
  origin->directory = fs::current_path();
  origin->is_override = true;
  try {
    return read_unquoted(assignment.substr(kKey.size()), origin);
  } catch (const ConfigError&) {
    return nullptr;
  }
}

/// Replaces the tracker's keys of a document by what an override names. Returns false if it names
/// no tracker file.
bool take_from_override(YamlNode& document, const std::string& assignment, Includes& includes) {
  auto value = tracker_value(assignment);
  const auto name = value ? name_in(*value) : std::nullopt;
  const YamlNode* tracker = name ? read(*name, includes) : nullptr;
  if (!tracker) return false;
  for (const std::string_view key : kKeysOfTrackers) remove(document, key);
  if (value->kind == YamlNode::Kind::kMap) {
    remove(*value, "from");
    document.add("tracker", std::move(value));
    includes.move_former(document);
  }
  join(document, *tracker);
  return true;
}

}  // namespace

std::vector<std::string> take_tracker(YamlNode& document, std::span<const std::string> overrides,
                                      Includes& includes) {
  std::vector<std::string> left(overrides.begin(), overrides.end());
  if (document.kind != YamlNode::Kind::kMap) return left;
  for (std::size_t i = left.size(); i-- > 0;) {
    if (!take_from_override(document, left[i], includes)) continue;
    // Those before it have no effect any more.
    const auto names_one = [](const std::string& assignment) {
      const auto value = tracker_value(assignment);
      return value && name_in(*value);
    };
    std::erase_if(left, names_one);
    return left;
  }
  const YamlNode::Entry* own = document.find("tracker");
  const auto name = own ? name_in(*own->value) : std::nullopt;
  const YamlNode* tracker = name ? read(*name, includes) : nullptr;
  if (!tracker) return left;
  remove(document, "tracker");
  join(document, *tracker);
  return left;
}

}  // namespace hypotrack::detail::internal
