#include "lab/report/plots/plot_parts.hpp"

#include "hypotrack/plugin/params.hpp"
#include "lab/json_file.hpp"

namespace hypotrack::internal {
namespace {

/// Returns the runs with a value on an axis; all runs if `key` is empty.
Runs with_value(const Runs& runs, const std::string& key, const std::string& value) {
  Runs found;
  for (const StudyRun* run : runs)
    if (key.empty() || run->on_axis(key) == value) found.push_back(run);
  return found;
}

}  // namespace

Json value_json(const StudyData& study, std::string_view key, const std::string& value) {
  double number = 0;
  if (study.is_numeric(key) && parse_number(value, number)) return number;
  return study.value_label(key, value);
}

Json dimension(const StudyData& study, const std::string& key, const std::string& label) {
  if (key.empty()) return nullptr;
  Json json;
  json["label"] = label.empty() ? study.axis_label(key) : label;
  json["numeric"] = study.is_numeric(key);
  json["values"] = Json::array();
  for (const std::string& value : study.values_of(key))
    json["values"].push_back(value_json(study, key, value));
  return json;
}

void for_each_value(const StudyData& study, const Runs& runs, const std::string& key,
                    const std::function<void(const std::string&, const Runs&)>& use) {
  if (key.empty()) return use("", runs);
  for (const std::string& value : study.values_of(key)) {
    const Runs here = with_value(runs, key, value);
    if (!here.empty()) use(value, here);
  }
}

std::string facet_label(const StudyData& study, const std::string& key, const std::string& value) {
  if (key.empty()) return "";
  return key == "scene" ? study.value_label(key, value) : study.axis_label(key) + " " + value;
}

}  // namespace hypotrack::internal
