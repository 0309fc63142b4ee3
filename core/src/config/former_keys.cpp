#include "config/former_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "hypotrack/api/error.hpp"
#include "hypotrack/api/text.hpp"

namespace hypotrack::detail::internal {
namespace {

std::unique_ptr<YamlNode> make_map(const YamlNode& like) {
  auto map = std::make_unique<YamlNode>();
  map->kind = YamlNode::Kind::kMap;
  map->origin = like.origin;
  map->line = like.line;
  map->column = like.column;
  return map;
}

/// Joins `value` into the value of a key. Where both have a key, `value` wins.
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
    throw ConfigError(fmt::format("{}: tracker.evidence: expected true or false", place_of(value)));
  if (document.find(kJudge))
    throw ConfigError(fmt::format(
        "{}: found tracker.evidence beside `judge`, which has replaced it; leave it out",
        place_of(value)));
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

template <class Keys>
std::vector<std::string> names_of(const Keys& keys) {
  std::vector<std::string> names;
  for (const FormerKey& key : keys) names.emplace_back(key.key);
  return names;
}

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
  YamlNode* const map = tracker->value.get();  // stays in the document while places are told
  if (YamlNode::Entry* const evidence = map->find(kEvidence)) {
    move_evidence(document, *evidence->value);
    moved.push_back(evidence->value->text == "true" ? "`tracker.evidence: true` is not needed"
                                                    : "`tracker.evidence: false` is `judge: none`");
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
          "{}: found the key '{}' in `tracker`, which names a tracker file{}; expected `tracker: "
          "\"@trackers/NAME\"`",
          map->origin->is_program ? place_of(*entry.value)
                                  : describe_position(*map->origin, entry.line, entry.column),
          entry.key, did_you_mean(entry.key, names_of(kFormerKeys))));
    }
  }
  const std::string place = place_of(*map);
  std::erase_if(document.entries, [&](const auto& entry) { return entry.value.get() == map; });
  if (moved.empty()) return {};
  return {fmt::format("{}: {} now; `hypotrack migrate FILE...` rewrites files", place,
                      fmt::join(moved, ", "))};
}

std::string path_today(std::string_view path) {
  constexpr std::string_view kBefore = "tracker.";
  if (!path.starts_with(kBefore)) return std::string(path);
  const std::string_view rest = path.substr(kBefore.size());
  const std::string_view first = rest.substr(0, rest.find('.'));
  const FormerKey* const key = former_key(first);
  return key ? path_now(*key) + std::string(rest.substr(first.size())) : std::string(path);
}

std::optional<std::string> override_today(YamlNode& document, const std::string& assignment,
                                          std::vector<std::string>& notes) {
  const std::size_t equals = std::min(assignment.find('='), assignment.size());
  const std::string path = assignment.substr(0, equals);
  std::string value = assignment.substr(equals);
  std::string today = path_today(path);
  if (path == "tracker.evidence" && (value == "=true" || value == "=false")) {
    today = kJudge;
    value = value == "=false" ? "=none" : "";
  }
  if (const std::size_t at = value.find_first_not_of("=\"'"); at < value.size() && value[at] == '@')
    value = value.substr(0, at + 1) + path_today(value.substr(at + 1));
  if (today != path)
    notes.push_back(fmt::format("--set {}: `{}` is `{}` now", assignment, path,
                                path == "tracker.evidence" ? "judge: none" : today));
  if (path == kTracker)  // it replaces all of them
    std::erase_if(document.entries, [](const YamlNode::Entry& entry) {
      return entry.key == "status" || entry.key == "recovery" || entry.key == "uncertainty";
    });
  const YamlNode::Entry* const judge = document.find(kJudge);
  const bool is_word =
      !judge || (judge->value->kind == YamlNode::Kind::kScalar && judge->value->text != kNone);
  if (today.starts_with("judge.") && is_word) (void)judge_of(document, document);
  if (value.empty() && equals < assignment.size()) return std::nullopt;
  return today + value;
}

}  // namespace hypotrack::detail::internal
