#include "config/former_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "hypotrack/error.hpp"

namespace hypotrack::detail::internal {
namespace {

std::string where(const YamlNode& node) {
  return describe_position(*node.origin, node.line, node.column);
}

std::unique_ptr<YamlNode> make_map(const YamlNode& like) {
  auto map = std::make_unique<YamlNode>();
  map->kind = YamlNode::Kind::kMap;
  map->origin = like.origin;
  map->line = like.line;
  map->column = like.column;
  return map;
}

/// Joins `value` into the value of a key. The former key wins: an override may have written it.
void join(YamlNode& into, const std::string& key, std::unique_ptr<YamlNode> value) {
  YamlNode::Entry* const there = into.find(key);
  if (!there) {
    into.add(key, std::move(value));
    return;
  }
  const bool are_maps =
      there->value->kind == YamlNode::Kind::kMap && value->kind == YamlNode::Kind::kMap;
  if (!are_maps) {
    value->parent = &into;
    there->value = std::move(value);
    return;
  }
  for (YamlNode::Entry& entry : value->entries)
    join(*there->value, entry.key, std::move(entry.value));
}

/// Returns the map of a judge's settings, made of the name of a judge if need be.
YamlNode& judge_of(YamlNode& document, const YamlNode& like) {
  YamlNode::Entry* judge = document.find(kJudge);
  if (judge && judge->value->kind == YamlNode::Kind::kMap) return *judge->value;
  auto map = make_map(like);
  auto type = judge ? std::move(judge->value) : make_scalar(std::string(kNetwork), true);
  if (!type->origin) type->origin = like.origin;
  map->add("type", std::move(type));
  if (!judge) return document.add(std::string(kJudge), std::move(map));
  map->parent = &document;
  judge->value = std::move(map);
  return *judge->value;
}

void move(YamlNode& document, const FormerKey& key, std::unique_ptr<YamlNode> value) {
  if (key.place == kJudge) {
    const YamlNode::Entry* const there = document.find(kJudge);
    if (there && there->value->text == kNone) return;  // which has no thresholds
    YamlNode& judge = judge_of(document, *value);
    return join(judge, std::string(key.key), std::move(value));
  }
  if (key.place.empty()) return join(document, std::string(key.key), std::move(value));
  auto map = make_map(*value);
  map->add(std::string(key.key), std::move(value));
  join(document, std::string(key.place), std::move(map));
}

void move_evidence(YamlNode& document, const YamlNode& value) {
  if (value.text == "true") return;
  if (value.text != "false")
    throw ConfigError(fmt::format("{}: tracker.evidence: expected true or false", where(value)));
  if (document.find(kJudge))
    throw ConfigError(fmt::format(
        "{}: found tracker.evidence beside `judge`, which has replaced it; leave it out",
        where(value)));
  auto none = make_scalar(std::string(kNone), true);
  none->origin = value.origin;
  none->line = value.line;
  none->column = value.column;
  join(document, std::string(kJudge), std::move(none));
}

constexpr std::array<FormerKey, 15> kFormerKeys{{{"recovery", ""},
                                                 {"uncertainty", ""},
                                                 {"motion", "status"},
                                                 {"history", "status"},
                                                 {"outlier", "status"},
                                                 {"patience", "status"},
                                                 {"min_visible", "status"},
                                                 {"uncertain_sigma_mm", "status"},
                                                 {"lost_sigma_mm", "status"},
                                                 {"check_pictures", "status"},
                                                 {"tracked_above", kJudge},
                                                 {"surely_above", kJudge},
                                                 {"first_above", kJudge},
                                                 {"confirmed_above", kJudge},
                                                 {"uncertain_above", kJudge}}};

}  // namespace

const FormerKey* former_key(std::string_view key) {
  const auto* const it = std::ranges::find(kFormerKeys, key, &FormerKey::key);
  return it == kFormerKeys.end() ? nullptr : it;
}

std::string path_now(const FormerKey& key) {
  return key.place.empty() ? std::string(key.key) : fmt::format("{}.{}", key.place, key.key);
}

std::vector<std::string> move_former_keys(YamlNode& document) {
  YamlNode::Entry* const tracker =
      document.kind == YamlNode::Kind::kMap ? document.find(kTracker) : nullptr;
  if (!tracker || tracker->value->kind != YamlNode::Kind::kMap) return {};
  std::vector<std::string> moved;
  const std::unique_ptr<YamlNode> map = std::move(tracker->value);
  std::erase_if(document.entries, [](const auto& entry) { return entry.key == kTracker; });
  if (YamlNode::Entry* const evidence = map->find(kEvidence)) {
    move_evidence(document, *evidence->value);
    moved.emplace_back("`tracker.evidence: false` is `judge: none`");
  }
  for (YamlNode::Entry& entry : map->entries) {
    const FormerKey* const key = former_key(entry.key);
    if (entry.key == kEvidence) continue;
    if (entry.key == kFrom) {
      document.add(std::string(kTracker), std::move(entry.value));
    } else if (key) {
      move(document, *key, std::move(entry.value));
      moved.push_back(fmt::format("`tracker.{}` is `{}`", key->key, path_now(*key)));
    } else {
      throw ConfigError(fmt::format(
          "{}: found the key '{}' in `tracker`, which names a tracker file; expected `tracker: "
          "\"@trackers/NAME\"`",
          describe_position(*map->origin, entry.line, entry.column), entry.key));
    }
  }
  if (moved.empty()) return {};
  return {fmt::format("{}: {} now; `hypotrack migrate FILE...` rewrites files", where(*map),
                      fmt::join(moved, ", "))};
}

}  // namespace hypotrack::detail::internal
