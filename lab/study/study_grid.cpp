#include "lab/study/study_grid.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <string_view>

#include "base/numbers.hpp"
#include "config/includes.hpp"
#include "config/overrides.hpp"
#include "config/read_value.hpp"
#include "config/yaml.hpp"
#include "hypotrack/api/text.hpp"
#include "lab/run_numbers.hpp"
#include "lab/study/study_file.hpp"

namespace hypotrack::study::internal {
namespace {

using detail::fail_at;
using detail::fail_type;

/// Columns of the tables beside the numbers of runs.
constexpr std::array<std::string_view, 6> kColumns = {"scene",   "seed", "status",
                                                      "message", "runs", "failed"};

/// Returns whether the tables have a column of this name, which no axis may have then.
bool is_column(std::string_view name) {
  if (std::ranges::find(kColumns, name) != kColumns.end()) return true;
  for (const std::string_view ending : {"_mean", "_sd", ""})
    if (name.ends_with(ending) &&
        std::ranges::find(run_numbers(), name.substr(0, name.size() - ending.size())) !=
            run_numbers().end())
      return true;
  return false;
}

Change read_change(const ConfigNode& map, const std::string& key) {
  const auto steps = detail::split_path(key);
  if (key.find('=') != std::string::npos ||
      std::find(steps.begin(), steps.end(), "") != steps.end())
    fail_at(map.get(key), "is no key of a scene; expected one such as optimizer.particles");
  return {key, to_flow(map.get(key)), map.where_key(key)};
}

/// Reads a choice of an axis that is a key: the value is its own label.
Choice read_value_choice(const std::string& key, const ConfigNode& value) {
  if (!value.is_scalar() || value.is_null() ||
      std::ranges::any_of(value.scalar(), [](unsigned char c) { return std::iscntrl(c); }))
    fail_at(value,
            "expected a number or words on one line; give values with a structure names: "
            "`AXIS: {NAME: {key: value, ...}, ...}`");
  Choice choice{value.scalar(), false, {{key, to_flow(value), value.where()}}};
  choice.is_number = value.is_plain() && detail::parse_number(value.scalar()).has_value();
  return choice;
}

void expect_distinct(const ConfigNode& node, const Axis& axis, const std::string& label) {
  const auto number = detail::parse_number(label);
  for (const Choice& choice : axis.choices) {
    if (choice.label == label) fail_at(node, fmt::format("'{}' is there twice", label));
    if (number && detail::parse_number(choice.label) == number)
      fail_at(node, fmt::format("'{}' is there already, as '{}'", label, choice.label));
  }
}

void read_values(const ConfigNode& list, Axis& axis) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    Choice choice = read_value_choice(axis.name, list.at(i));
    expect_distinct(list.at(i), axis, choice.label);
    axis.choices.push_back(std::move(choice));
  }
}

void read_cases(const ConfigNode& map, Axis& axis) {
  if (!is_word(axis.name))
    fail_at(map, fmt::format("expected a list of values for the key '{}'; named cases need an axis "
                             "whose name is a word of letters, digits, '_' and '-'",
                             axis.name));
  axis.is_key = false;
  for (const std::string& name : map.keys()) {
    if (!is_word(name))
      fail_at(map.get(name), "the name of a case is a word of letters, digits, '_' and '-'");
    if (!map.get(name).is_map()) fail_type(map.get(name), "a map of changes, `{key: value, ...}`");
    axis.choices.push_back({name, false, read_changes(map.get(name))});
  }
}

Axis read_axis(const ConfigNode& grid, const std::string& name) {
  if (is_column(name))
    fail_at(grid.get(name), fmt::format("the tables have a column '{}' of their own; give the axis "
                                        "another name",
                                        name));
  const ConfigNode node = grid.get(name);
  Axis axis{name, true, {}};
  if (node.is_list()) {
    read_change(grid, name);  // the name must be a key
    read_values(node, axis);
  } else if (node.is_map()) {
    read_cases(node, axis);
  } else {
    fail_type(node, "a list of values, or a map of named cases");
  }
  if (axis.choices.empty()) fail_at(node, "an axis needs at least one value");
  return axis;
}

}  // namespace

std::vector<Change> read_changes(const ConfigNode& map) {
  std::vector<Change> changes;
  if (map.defined() && !map.is_map()) fail_type(map, "a map of changes, `{key: value, ...}`");
  for (const std::string& key : map.keys()) changes.push_back(read_change(map, key));
  return changes;
}

std::string content_of(const Change& change, const std::filesystem::path& directory) {
  auto origin = std::make_shared<detail::YamlOrigin>();
  origin->name = change.where;
  origin->directory = directory;
  origin->is_override = true;
  std::unique_ptr<detail::YamlNode> value;
  if (change.key == "tracker") {  // what a tracker file has, not its name
    value = std::make_unique<detail::YamlNode>();
    value->kind = detail::YamlNode::Kind::kMap;
    value->origin = origin;
    value->add("tracker", detail::read_unquoted(change.value, origin));
    detail::Includes includes;
    includes.move_former(*value);
    detail::take_tracker(*value, {}, includes);
    for (detail::YamlNode::Entry& entry : value->entries)
      detail::resolve_includes(entry.value, {entry.key});
  } else {
    value = detail::read_assigned(change.key, change.value, origin);
  }
  return to_flow(ConfigNode::parse(detail::write_yaml(*value), change.where));
}

void add_changes(std::vector<Change>& changes, const std::vector<Change>& more) {
  for (const Change& change : more) {
    std::erase_if(changes, [&](const Change& old) { return old.key == change.key; });
    changes.push_back(change);
  }
}

std::vector<Axis> read_grid(const ConfigNode& grid) {
  std::vector<Axis> axes;
  if (grid.defined() && !grid.is_map()) fail_type(grid, "a map of axes to their values");
  for (const std::string& name : grid.keys()) axes.push_back(read_axis(grid, name));
  return axes;
}

void replace_choices(std::vector<Axis>& axes, const ConfigNode& grid) {
  for (Axis& axis : read_grid(grid)) {
    const auto same = [&](const Axis& other) { return other.name == axis.name; };
    const auto at = std::find_if(axes.begin(), axes.end(), same);
    if (at == axes.end()) {
      std::vector<std::string> names;
      for (const Axis& other : axes) names.push_back(other.name);
      fail_at(grid.get(axis.name),
              fmt::format("is no axis of the study{}; its axes are: {}",
                          did_you_mean(axis.name, names), fmt::join(names, ", ")));
    }
    *at = std::move(axis);
  }
}

}  // namespace hypotrack::study::internal
