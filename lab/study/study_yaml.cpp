#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include "config/yaml.hpp"
#include "lab/study/study_file.hpp"

namespace hypotrack::study::internal {
namespace {

std::string on_one_line(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

std::string joined_items(const ConfigNode& list) {
  std::string text;
  for (std::size_t i = 0; i < list.size(); ++i) text += (i == 0 ? "" : ", ") + to_flow(list.at(i));
  return text;
}

std::string joined_entries(const ConfigNode& map) {
  std::string text;
  for (const std::string& key : map.keys()) {
    if (!text.empty()) text += ", ";
    text += (is_word(key) ? key : yaml_scalar(key)) + ": " + to_flow(map.get(key));
  }
  return text;
}

std::string key_of(const std::string& key) { return is_word(key) ? key : yaml_scalar(key); }

std::string flow_of(const std::vector<Change>& changes) {
  std::vector<std::string> entries;
  for (const Change& change : changes) entries.push_back(key_of(change.key) + ": " + change.value);
  return fmt::format("{{{}}}", fmt::join(entries, ", "));
}

std::string scenes_text(const Study& study) {
  std::string text = "scenes:\n";
  for (const StudyScene& scene : study.scenes)
    text += fmt::format("  {}:\n    file: {}\n    label: {}\n    set: {}\n", key_of(scene.name),
                        yaml_scalar(scene.file.string()), yaml_scalar(scene.label),
                        flow_of(scene.changes));
  return text;
}

std::string grid_text(const Study& study) {
  std::string text = study.axes.empty() ? "" : "grid:\n";
  for (const Axis& axis : study.axes) {
    std::vector<std::string> items;
    for (const Choice& choice : axis.choices)
      items.push_back(
          axis.is_key ? choice.changes.front().value
                      : fmt::format("    {}: {}\n", key_of(choice.label), flow_of(choice.changes)));
    text += axis.is_key ? fmt::format("  {}: [{}]\n", key_of(axis.name), fmt::join(items, ", "))
                        : fmt::format("  {}:\n{}", key_of(axis.name), fmt::join(items, ""));
  }
  return text;
}

std::string plot_text(const Plot& plot) {
  std::string text =
      fmt::format("kind: {}", enum_names(plot.kind)[static_cast<std::size_t>(plot.kind)]);
  const std::pair<const char*, const std::string*> keys[] = {{"x", &plot.x},
                                                             {"y", &plot.y},
                                                             {"value", &plot.value},
                                                             {"color", &plot.color},
                                                             {"facet", &plot.facet},
                                                             {"title", &plot.title},
                                                             {"x_label", &plot.x_label},
                                                             {"y_label", &plot.y_label}};
  for (const auto& [key, value] : keys)
    if (!value->empty()) text += fmt::format(", {}: {}", key, yaml_scalar(*value));
  return fmt::format("  - {{{}}}\n", text);
}

}  // namespace

std::string to_flow(const ConfigNode& node) {
  if (node.is_list()) return "[" + joined_items(node) + "]";
  if (node.is_map()) return "{" + joined_entries(node) + "}";
  return on_one_line(node.to_yaml());
}

std::string yaml_scalar(std::string_view text) {
  return on_one_line(detail::write_yaml(*detail::make_scalar(std::string(text), false)));
}

bool is_word(std::string_view text) {
  return !text.empty() && text.front() != '-' &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
}

std::string to_yaml(const Study& study) {
  std::string text =
      fmt::format("title: {}\nabout: {}\n", yaml_scalar(study.title), yaml_scalar(study.about));
  text += scenes_text(study) + grid_text(study);
  text += fmt::format("seeds: [{}]\n", fmt::join(study.seeds, ", "));
  if (study.frames) text += fmt::format("frames: {}\n", *study.frames);
  text += fmt::format("overlay: {}\nrecordings: {}\nredraw: {}\ntrace: {}\ndirectory: {}\n",
                      study.overlay, study.recordings,
                      enum_names(study.redraw)[static_cast<std::size_t>(study.redraw)], study.trace,
                      yaml_scalar(study.directory.string()));
  if (!study.tolerances.empty())
    text += fmt::format("tolerances: [{}]\n", fmt::join(study.tolerances, ", "));
  if (!study.table_per.empty())
    text += fmt::format("table_per: {}\n", yaml_scalar(study.table_per));
  if (!study.plots.empty()) text += "plots:\n";
  for (const Plot& plot : study.plots) text += plot_text(plot);
  return text;
}

}  // namespace hypotrack::study::internal
