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
    return join(judge, std::string(key.now.empty() ? key.key : key.now), std::move(value));
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

/// A key of a map of the scene (`place`), or of maps of a `type`, that has another name now.
struct RenamedKey {
  std::string_view place, type, key, now;
};
constexpr std::array<RenamedKey, 7> kRenamedKeys{
    {{"search", "", "second_look", "second_search"},
     {"recovery", "", "first_starts", "first_restarts"},
     {kJudge, "", "surely_above", "certain_above"},
     {"", "stereo_color", "charge", "coverage_penalty"},
     {"", "multi_start", "starts", "restarts"},
     {"", "levenberg_marquardt", "starts", "restarts"},
     {"", "pipeline", "rescue", "fallback"}}};

/// Returns the key of the root that leads directly to a node, or nothing.
std::string_view key_of_root(const YamlNode& node) {
  if (!node.parent || node.parent->parent || node.parent->kind != YamlNode::Kind::kMap) return {};
  const auto it = std::ranges::find(node.parent->entries, &node,
                                    [](const YamlNode::Entry& entry) { return entry.value.get(); });
  return it == node.parent->entries.end() ? std::string_view() : std::string_view(it->key);
}

/// Returns the type of the plugin whose parameters a map has, stages of a pipeline included.
std::string_view type_of(const YamlNode& map) {
  if (const YamlNode::Entry* const type = map.find("type")) return type->value->text;
  const YamlNode* const list = map.parent;
  if (!list || list->kind != YamlNode::Kind::kList || !list->parent) return {};
  const YamlNode::Entry* const stages = list->parent->find("stages");
  return stages && stages->value.get() == list ? type_of(*list->parent) : std::string_view();
}

/// Gives the keys below a node their names of today. Adds a line for each former one to `notes`.
void rename_keys(YamlNode& node, std::vector<std::string>& notes) {
  std::vector<const YamlNode*> replaced;
  for (YamlNode::Entry& entry : node.entries) {
    rename_keys(*entry.value, notes);
    const auto now = new_name(node, entry);
    if (!now) continue;
    std::string& text = now->is_of_value ? entry.value->text : entry.key;
    notes.push_back(fmt::format("{}: `{}` is `{}` now; `hypotrack migrate FILE...` rewrites files",
                                place_of(*entry.value), text, now->name));
    if (const YamlNode::Entry* const there = now->is_of_value ? nullptr : node.find(now->name))
      replaced.push_back(there->value.get());
    text = now->name;
  }
  std::erase_if(node.entries, [&](const YamlNode::Entry& entry) {
    return std::ranges::find(replaced, entry.value.get()) != replaced.end();
  });
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
                                                 {"surely_above", kJudge, "certain_above"},
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
  const std::string_view name = key.now.empty() ? key.key : key.now;
  return key.place.empty() ? std::string(name) : fmt::format("{}.{}", key.place, name);
}

std::optional<NewName> new_name(const YamlNode& map, const YamlNode::Entry& entry) {
  if (map.kind != YamlNode::Kind::kMap) return std::nullopt;
  const std::string_view place = key_of_root(map);
  if (place == "shape" && entry.key == kFrom && entry.value->text == "starts")
    return NewName{"starters", true};
  const auto* const it = std::ranges::find_if(kRenamedKeys, [&](const RenamedKey& key) {
    if (key.key != entry.key) return false;
    return key.place.empty() ? key.type == type_of(map) : key.place == place;
  });
  return it == kRenamedKeys.end() ? std::nullopt : std::optional(NewName{it->now});
}

namespace {

/// Moves the former keys of `tracker`. Returns a note for the user, or nothing.
std::vector<std::string> move_keys_of_tracker(YamlNode& document) {
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

}  // namespace

std::vector<std::string> move_former_keys(YamlNode& document) {
  std::vector<std::string> notes = move_keys_of_tracker(document);
  rename_keys(document, notes);
  return notes;
}

std::string path_today(std::string_view path) {
  constexpr std::string_view kBefore = "tracker.";
  for (const RenamedKey& key : kRenamedKeys)
    if (!key.place.empty() && path == fmt::format("{}.{}", key.place, key.key))
      return fmt::format("{}.{}", key.place, key.now);
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
